// SPDX-License-Identifier: Apache-2.0
// Vector form of integrate_emission(): the rules on whole pieces. Pieces that have to be bisected
// are left to the scalar form.
#include "reference/emission_batch.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "reference/emission_batch.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "reference/patterson_rules.h"

// After highway.h, which it needs for each target.
#include <hwy/contrib/math/math-inl.h>

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {
namespace reference {

namespace hn = hwy::HWY_NAMESPACE;
using Lanes = hn::ScalableTag<double>;
using Doubles = hn::Vec<Lanes>;

HWY_INLINE Doubles number(double value) {
    return hn::Set(Lanes(), value);
}

struct Cubics {
    Doubles c[4];

    HWY_INLINE Doubles at(Doubles t) const {
        return hn::MulAdd(hn::MulAdd(hn::MulAdd(c[3], t, c[2]), t, c[1]), t, c[0]);
    }
};

HWY_INLINE Cubics load_cubics(const double (&from)[4][EmissionBatch::capacity], std::size_t i) {
    Cubics cubics;
    for (std::size_t power = 0; power < 4; ++power)
        cubics.c[power] = hn::Load(Lanes(), from[power] + i);
    return cubics;
}

// Sums of the rules so far: of w = extinction exp(-depth), and of x w.
struct RuleSum {
    Doubles w, xw;

    HWY_INLINE void add(double weight, Doubles node_w, Doubles node_xw) {
        w = hn::MulAdd(number(weight), node_w, w);
        xw = hn::MulAdd(number(weight), node_xw, xw);
    }
};

HWY_INLINE RuleSum no_sum() {
    return {hn::Zero(Lanes()), hn::Zero(Lanes())};
}

class PieceLanes {
  public:
    HWY_INLINE PieceLanes(const EmissionBatch& batch, std::size_t i)
        : position_(load_cubics(batch.position, i)),
          extinction_(load_cubics(batch.extinction, i)),
          mean_depth_(extinction_) {
        for (std::size_t power = 1; power < 4; ++power)
            mean_depth_.c[power] =
                hn::Div(extinction_.c[power], number(static_cast<double>(power + 1)));
    }

    // Sets w and x w to their sums over a pair of nodes.
    HWY_INLINE void evaluate(int pair, Doubles& w, Doubles& xw) const {
        const double distance = patterson::node[pair];
        w = weight_at(0.5 - distance);
        xw = hn::Mul(position_.at(number(0.5 - distance)), w);
        if (pair == 0) return;
        const Doubles right = weight_at(0.5 + distance);
        w = hn::Add(w, right);
        xw = hn::MulAdd(position_.at(number(0.5 + distance)), right, xw);
    }

    HWY_INLINE Doubles middle() const { return position_.at(number(0.5)); }

  private:
    HWY_INLINE Doubles weight_at(double place) const {
        const Doubles t = number(place);
        const Doubles depth = hn::Mul(t, mean_depth_.at(t));
        return hn::Mul(extinction_.at(t), hn::Exp(Lanes(), hn::Neg(depth)));
    }

    Cubics position_, extinction_, mean_depth_;  // mean_depth_ t is the depth up to t
};

HWY_INLINE Doubles difference(const RuleSum& fine, const RuleSum& coarse, Doubles opacity) {
    return hn::Max(hn::Abs(hn::Sub(fine.xw, coarse.xw)), hn::Abs(hn::Sub(fine.w, opacity)));
}

// Returns the lanes that a rule has integrated.
HWY_INLINE hn::Mask<Lanes> integrate_lanes(EmissionBatch& batch, std::size_t i) {
    using namespace patterson;
    const Lanes d;
    const PieceLanes pieces(batch, i);
    const Doubles depth = hn::Load(d, batch.depth + i);
    const Doubles opacity = hn::Neg(hn::Expm1(d, hn::Neg(depth)));
    const Doubles transmittance = hn::Exp(d, hn::Neg(hn::Load(d, batch.before + i)));
    const Doubles span = hn::Load(d, batch.color_span + i);
    const Doubles allowed =
        hn::Div(hn::MulAdd(number(batch.error_of_opacity), hn::Mul(opacity, transmittance),
                           hn::Load(d, batch.error_of_length + i)),
                hn::Mul(transmittance, span));
    const Doubles enough = hn::Max(allowed, hn::Mul(number(emission_rounding), depth));

    Doubles w[8], xw[8];
    RuleSum three = no_sum(), seven = no_sum(), fifteen = no_sum();
    for (int pair = 0; pair < 4; ++pair) {
        pieces.evaluate(pair, w[pair], xw[pair]);
        if (pair < 2) three.add(weight3[pair], w[pair], xw[pair]);
        seven.add(weight7[pair], w[pair], xw[pair]);
    }
    Doubles value = seven.xw, error = difference(seven, three, opacity);
    // Lanes behind the last piece hold anything.
    auto done = hn::Or(hn::Le(error, enough), hn::Not(hn::FirstN(d, batch.count - i)));
    if (!hn::AllTrue(d, done)) {
        for (int pair = 0; pair < 8; ++pair) {
            if (pair >= 4) pieces.evaluate(pair, w[pair], xw[pair]);
            fifteen.add(weight15[pair], w[pair], xw[pair]);
        }
        value = hn::IfThenElse(done, value, fifteen.xw);
        error = hn::IfThenElse(done, error, difference(fifteen, seven, opacity));
        done = hn::Le(error, enough);
    }
    done = hn::And(done, hn::Lt(depth, number(resolvable_depth)));
    // x is somewhere in [0, 1], so any of its values is within `opacity` of the integral.
    const auto faint = hn::Le(opacity, hn::Mul(number(negligible_opacity), allowed));
    value = hn::IfThenElse(faint, hn::Mul(pieces.middle(), opacity), value);
    error = hn::IfThenElse(faint, opacity, error);
    hn::Store(transmittance, d, batch.transmittance + i);
    hn::Store(opacity, d, batch.opacity + i);
    hn::Store(value, d, batch.value + i);
    hn::Store(error, d, batch.error + i);
    return hn::Or(done, faint);
}

// Sets the results, and left[i] to 1 where a piece is left to do.
inline void integrate_rules(EmissionBatch& batch, std::uint8_t* left) {
    const Lanes d;
    const std::size_t lanes = hn::Lanes(d);
    for (std::size_t i = 0; i < batch.count; i += lanes) {
        alignas(64) std::int64_t done[HWY_MAX_BYTES / 8];
        const auto mask = integrate_lanes(batch, i);
        hn::Store(hn::BitCast(hn::ScalableTag<std::int64_t>(), hn::VecFromMask(d, mask)),
                  hn::ScalableTag<std::int64_t>(), done);
        for (std::size_t lane = 0; lane < lanes; ++lane) left[i + lane] = done[lane] == 0;
    }
}

}  // namespace reference
// HWY_EXPORT takes functions of this namespace alone.
inline void integrate_batch(EmissionBatch& batch, std::uint8_t* left) {
    reference::integrate_rules(batch, left);
}
}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lamina {

HWY_EXPORT(integrate_batch);

void integrate_emission(EmissionBatch& batch) {
    std::uint8_t left[EmissionBatch::capacity];
    HWY_DYNAMIC_DISPATCH(integrate_batch)(batch, left);
    for (std::size_t i = 0; i < batch.count; ++i) {
        if (left[i] == 0 || !(batch.color_span[i] > 0) || !(batch.transmittance[i] > 0)) continue;
        const double reach = batch.transmittance[i] * batch.color_span[i];
        const EmissionIntegral emission =
            integrate_emission(batch.piece(i), batch.error_of_length[i] / reach,
                               batch.error_of_opacity / batch.color_span[i]);
        batch.value[i] = emission.value;
        batch.error[i] = emission.error;
    }
}

}  // namespace lamina
#endif
