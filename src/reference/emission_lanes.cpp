// SPDX-License-Identifier: Apache-2.0
// Vector form of integrate_emission(): the rules on whole pieces. Pieces that have to be bisected
// are left to the scalar form.
#include "reference/piece_batch.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "reference/emission_lanes.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// After highway.h, which it needs for each target.
#include "reference/cubic_lanes-inl.h"
#include "reference/depth_lanes-inl.h"
#include "reference/patterson_rules.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {
namespace reference {

HWY_INLINE Cubics load_cubics(const PieceBatch::Column (&from)[4], std::size_t i) {
    Cubics cubics;
    for (std::size_t power = 0; power < 4; ++power)
        cubics.c[power] = hn::LoadU(Lanes(), from[power].data() + i);
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

template <typename Depth>
class PieceLanes {
  public:
    HWY_INLINE PieceLanes(const PieceBatch& batch, std::size_t i, const Depth& depth)
        : depth_(depth),
          position_(load_cubics(batch.position, i)),
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
        return hn::Mul(extinction_.at(t), depth_.exp(depth));
    }

    Depth depth_;
    Cubics position_, extinction_, mean_depth_;  // mean_depth_ t is the depth up to t
};

HWY_INLINE Doubles difference(const RuleSum& fine, const RuleSum& coarse, Doubles opacity) {
    return hn::Max(hn::Abs(hn::Sub(fine.xw, coarse.xw)), hn::Abs(hn::Sub(fine.w, opacity)));
}

HWY_INLINE Mask given(const PieceBatch& batch, std::size_t i) {
    return hn::FirstN(Lanes(), batch.count - i);
}

// Returns the lanes that a rule has integrated.
template <typename Depth>
HWY_INLINE Mask integrate_lanes(PieceBatch& batch, std::size_t i, const Depth& kind) {
    using namespace patterson;
    const Lanes d;
    const PieceLanes<Depth> pieces(batch, i, kind);
    const Doubles depth = hn::LoadU(d, batch.depth.data() + i);
    const Doubles opacity = kind.opacity(depth);
    const Doubles transmittance = hn::Exp(d, hn::Neg(hn::LoadU(d, batch.before.data() + i)));
    const Doubles span = hn::LoadU(d, batch.color_span.data() + i);
    const Doubles allowed =
        hn::Div(hn::MulAdd(number(batch.error_of_opacity), hn::Mul(opacity, transmittance),
                           hn::LoadU(d, batch.error_of_length.data() + i)),
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
    const Mask beyond = hn::Not(given(batch, i));
    Mask done = hn::Or(hn::Le(error, enough), beyond);
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
    const Mask faint = hn::Le(opacity, hn::Mul(number(negligible_opacity), allowed));
    value = hn::IfThenElse(faint, hn::Mul(pieces.middle(), opacity), value);
    error = hn::IfThenElse(faint, opacity, error);
    hn::StoreU(transmittance, d, batch.transmittance.data() + i);
    hn::StoreU(opacity, d, batch.opacity.data() + i);
    hn::StoreU(value, d, batch.value.data() + i);
    hn::StoreU(error, d, batch.error.data() + i);
    return hn::Or(hn::Or(done, faint), beyond);
}

// A piece that the rules on the whole of it do not integrate.
inline void integrate_bisected(PieceBatch& batch, std::size_t i) {
    if (!(batch.color_span[i] > 0) || !(batch.transmittance[i] > 0)) return;
    const double reach = batch.transmittance[i] * batch.color_span[i];
    const EmissionIntegral emission =
        integrate_emission(batch.piece(i), batch.error_of_length[i] / reach,
                           batch.error_of_opacity / batch.color_span[i]);
    batch.value[i] = emission.value;
    batch.error[i] = emission.error;
}

}  // namespace reference

// HWY_EXPORT takes functions of this namespace alone.
inline void integrate_batch(PieceBatch& batch) {
    using namespace reference;
    const std::size_t lanes = hn::Lanes(Lanes());
    for (std::size_t i = 0; i < batch.count; i += lanes) {
        const Doubles depth = hn::LoadU(Lanes(), batch.depth.data() + i);
        const Mask is_short = hn::Le(depth, number(short_depth));
        // Lanes behind the last piece hold anything.
        const bool all_short = hn::AllTrue(Lanes(), hn::Or(is_short, hn::Not(given(batch, i))));
        const Mask done = all_short ? integrate_lanes(batch, i, ShortDepth<most_terms>())
                                    : integrate_lanes(batch, i, MixedDepth{is_short});
        if (hn::AllTrue(Lanes(), done)) continue;
        for_each_lane(set_of(hn::Not(done)),
                      [&](std::size_t lane) { integrate_bisected(batch, i + lane); });
    }
}
}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lamina {

HWY_EXPORT(integrate_batch);

void integrate_emission(PieceBatch& batch) {
    HWY_DYNAMIC_DISPATCH(integrate_batch)(batch);
}

}  // namespace lamina
#endif
