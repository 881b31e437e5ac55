// SPDX-License-Identifier: Apache-2.0
// Vector form of integrate_emission(): the rules on whole pieces. Pieces that have to be bisected
// are left to the scalar form.
#include "reference/piece_batch.h"

#undef LAMINA_TARGET_FILE
#define LAMINA_TARGET_FILE "reference/emission_lanes.cpp"
#include "simd/foreach_target.h"

#include "reference/cubic-inl.h"
#include "reference/depth_lanes-inl.h"
#include "reference/patterson_rules.h"

LAMINA_SIMD_BEGIN
namespace reference {

LAMINA_INLINE Cubics load_cubics(const PieceBatch::Column (&from)[4], std::size_t i) {
    Cubics cubics;
    for (std::size_t power = 0; power < 4; ++power)
        cubics.c[power] = load_unaligned<Double>(from[power].data() + i);
    return cubics;
}

// Sums of the rules so far: of w = extinction exp(-depth), and of x w.
struct RuleSum {
    Double w, xw;

    LAMINA_INLINE void add(double weight, Double node_w, Double node_xw) {
        w = fma(weight, node_w, w);
        xw = fma(weight, node_xw, xw);
    }
};

LAMINA_INLINE RuleSum no_sum() {
    return {0, 0};
}

template <typename Depth>
class PieceLanes {
  public:
    LAMINA_INLINE PieceLanes(const PieceBatch& batch, std::size_t i, const Depth& depth)
        : depth_(depth),
          position_(load_cubics(batch.position, i)),
          extinction_(load_cubics(batch.extinction, i)),
          mean_depth_(extinction_) {
        for (std::size_t power = 1; power < 4; ++power)
            mean_depth_.c[power] = extinction_.c[power] / static_cast<double>(power + 1);
    }

    // Sets w and x w to their sums over a pair of nodes.
    LAMINA_INLINE void evaluate(int pair, Double& w, Double& xw) const {
        const double distance = patterson::node[pair];
        w = weight_at(0.5 - distance);
        xw = position_.at(0.5 - distance) * w;
        if (pair == 0) return;
        const Double right = weight_at(0.5 + distance);
        w += right;
        xw = fma(position_.at(0.5 + distance), right, xw);
    }

    LAMINA_INLINE Double middle() const { return position_.at(0.5); }

  private:
    LAMINA_INLINE Double weight_at(double place) const {
        const Double t(place);
        const Double depth = t * mean_depth_.at(t);
        return extinction_.at(t) * depth_.transmittance(depth);
    }

    Depth depth_;
    Cubics position_, extinction_, mean_depth_;  // mean_depth_ t is the depth up to t
};

LAMINA_INLINE Double difference(const RuleSum& fine, const RuleSum& coarse, Double opacity) {
    return max(abs(fine.xw - coarse.xw), abs(fine.w - opacity));
}

LAMINA_INLINE DoubleMask given(const PieceBatch& batch, std::size_t i) {
    return first_lanes<DoubleMask>(batch.count - i);
}

// Returns the lanes that a rule has integrated.
template <typename Depth>
LAMINA_INLINE DoubleMask integrate_lanes(PieceBatch& batch, std::size_t i, const Depth& kind) {
    using namespace patterson;
    const PieceLanes<Depth> pieces(batch, i, kind);
    const Double depth = load_unaligned<Double>(batch.depth.data() + i);
    const Double opacity = kind.opacity(depth);
    const Double transmittance = exp(-load_unaligned<Double>(batch.before.data() + i));
    const Double span = load_unaligned<Double>(batch.color_span.data() + i);
    const Double allowed = fma(batch.error_of_opacity, opacity * transmittance,
                               load_unaligned<Double>(batch.error_of_length.data() + i)) /
                           (transmittance * span);
    const Double enough = max(allowed, emission_rounding * depth);

    Double w[8], xw[8];
    RuleSum three = no_sum(), seven = no_sum(), fifteen = no_sum();
    for (int pair = 0; pair < 4; ++pair) {
        pieces.evaluate(pair, w[pair], xw[pair]);
        if (pair < 2) three.add(weight3[pair], w[pair], xw[pair]);
        seven.add(weight7[pair], w[pair], xw[pair]);
    }
    Double value = seven.xw, error = difference(seven, three, opacity);
    const DoubleMask beyond = !given(batch, i);
    DoubleMask done = (error <= enough) | beyond;
    if (!all_of(done)) {
        for (int pair = 0; pair < 8; ++pair) {
            if (pair >= 4) pieces.evaluate(pair, w[pair], xw[pair]);
            fifteen.add(weight15[pair], w[pair], xw[pair]);
        }
        value = select(done, value, fifteen.xw);
        error = select(done, error, difference(fifteen, seven, opacity));
        done = error <= enough;
    }
    done = done & (depth < resolvable_depth);
    // x is somewhere in [0, 1], so any of its values is within `opacity` of the integral.
    const DoubleMask faint = opacity <= negligible_opacity * allowed;
    value = select(faint, pieces.middle() * opacity, value);
    error = select(faint, opacity, error);
    store_unaligned(transmittance, batch.transmittance.data() + i);
    store_unaligned(opacity, batch.opacity.data() + i);
    store_unaligned(value, batch.value.data() + i);
    store_unaligned(error, batch.error.data() + i);
    return done | faint | beyond;
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

// LAMINA_EXPORT takes functions of this namespace alone.
inline void integrate_batch(PieceBatch& batch) {
    using namespace reference;
    const std::size_t lanes = Double::lanes;
    for (std::size_t i = 0; i < batch.count; i += lanes) {
        const Double depth = load_unaligned<Double>(batch.depth.data() + i);
        const DoubleMask is_short = depth <= short_depth;
        // Lanes behind the last piece hold anything.
        const bool all_short = all_of(is_short | !given(batch, i));
        const DoubleMask done = all_short ? integrate_lanes(batch, i, ShortDepth<most_terms>())
                                          : integrate_lanes(batch, i, MixedDepth{is_short});
        if (all_of(done)) continue;
        for_each_lane(bits_of(!done),
                      [&](std::size_t lane) { integrate_bisected(batch, i + lane); });
    }
}
LAMINA_SIMD_END

#if LAMINA_ONCE
namespace lamina {

LAMINA_EXPORT(integrate_batch);

void integrate_emission(PieceBatch& batch) {
    LAMINA_DISPATCH(integrate_batch)(batch);
}

}  // namespace lamina
#endif
