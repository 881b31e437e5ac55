// SPDX-License-Identifier: Apache-2.0
#include "reference/integrate.h"

#include "optics/segment_integral.h"

#undef LAMINA_TARGET_FILE
#define LAMINA_TARGET_FILE "reference/integrate.cpp"
#include "simd/foreach_target.h"

#include "reference/cubic-inl.h"
#include "simd/math-inl.h"

LAMINA_SIMD_BEGIN
namespace reference {

// Largest depth up to which so many terms of Taylor's series of (exp(-depth) - 1) / depth are
// enough: the remainder is below depth^(terms + 1) / (terms + 2)! = 7e-18, 1e-16 and 5e-16.
template <std::size_t terms>
inline constexpr double series_limit = terms == 6   ? 0.016
                                       : terms == 8 ? 0.09
                                                    : 0.25;

// (exp(-depth) - 1) / depth.
template <std::size_t terms>
LAMINA_INLINE Double short_expm1_share(Double depth) {
    static_assert(terms == 6 || terms == 8 || terms == 10, "series_limit");
    constexpr double inverse_factorials[] = {1. / 2,       1. / 6,       1. / 24,    1. / 120,
                                             1. / 720,     1. / 5040,    1. / 40320, 1. / 362880,
                                             1. / 3628800, 1. / 39916800};
    Double sum = inverse_factorials[terms - 1];
    for (std::size_t i = terms - 1; i-- > 0;) sum = fnma(depth, sum, inverse_factorials[i]);
    return fms(depth, sum, 1);
}

// Transmittance exp(-depth) and opacity 1 - exp(-depth) of any depths.
struct AnyDepth {
    LAMINA_INLINE Double transmittance(Double depth) const { return exp(-depth); }
    LAMINA_INLINE Double opacity(Double depth) const { return -expm1(-depth); }
};

// Transmittance and opacity of depths up to series_limit<terms>.
template <std::size_t terms>
struct ShortDepth {
    LAMINA_INLINE Double transmittance(Double depth) const {
        return fma(depth, short_expm1_share<terms>(depth), 1);
    }
    LAMINA_INLINE Double opacity(Double depth) const {
        return -(depth * short_expm1_share<terms>(depth));
    }
};

// Largest depth that counts as short.
constexpr std::size_t most_terms = 10;
constexpr double short_depth = series_limit<most_terms>;

// Transmittance and opacity of depths that are short in some lanes. Each lane's result does not
// depend on the other lanes.
struct MixedDepth {
    DoubleMask is_short;

    LAMINA_INLINE Double transmittance(Double depth) const {
        return select(is_short, ShortDepth<most_terms>().transmittance(depth),
                      AnyDepth().transmittance(depth));
    }
    LAMINA_INLINE Double opacity(Double depth) const {
        return select(is_short, ShortDepth<most_terms>().opacity(depth), AnyDepth().opacity(depth));
    }
};

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

struct WeightLanes {
    Double front, back;
};

// Vector form of the sums in optics/segment_integral.cpp, which gives the reasons for their form.
template <typename Depth>
LAMINA_INLINE WeightLanes weights_by_rule(const GaussRule& rule, Double p, Double q,
                                          const Depth& kind) {
    WeightLanes sum{0, 0};
    for (std::size_t i = 0; i < rule.points; ++i) {
        const double x = rule.x[i], rest = 1 - x;
        const Double before = fma(x * (1 - x / 2), p, x * x / 2 * q);
        const Double behind = fma(rest * rest / 2, p, rest * (1 + x) / 2 * q);
        const Double absorbed = kind.opacity(before), weight(rule.weight[i]);
        sum.front = fma(weight, absorbed, sum.front);
        sum.back = fma(weight * (1 - absorbed), kind.opacity(behind), sum.back);
    }
    return sum;
}

LAMINA_INLINE WeightLanes closed_weights(Double p, Double q) {
    alignas(64) double ps[longest_vector], qs[longest_vector], fronts[longest_vector],
        backs[longest_vector];
    store(p, ps);
    store(q, qs);
    for (std::size_t lane = 0; lane < Double::lanes; ++lane) {
        const PieceWeights weights = piece_weights(ps[lane], qs[lane]);
        fronts[lane] = weights.front;
        backs[lane] = weights.back;
    }
    return {load<Double>(fronts), load<Double>(backs)};
}

// Weighs pieces as piece_weights() does.
LAMINA_INLINE WeightLanes weights_of(Double p, Double q, Double depth) {
    const double most = largest_of(depth);
    if (!(most < largest_gauss_depth)) return closed_weights(p, q);
    const GaussRule& rule = gauss_rule(most);
    if (most <= series_limit<6>) return weights_by_rule(rule, p, q, ShortDepth<6>());
    if (most <= series_limit<8>) return weights_by_rule(rule, p, q, ShortDepth<8>());
    if (most <= series_limit<10>) return weights_by_rule(rule, p, q, ShortDepth<10>());
    return weights_by_rule(rule, p, q, AnyDepth());
}

LAMINA_INLINE void weigh(LinearPieces& pieces, std::size_t i) {
    // Lanes behind the last piece hold anything.
    const DoubleMask given = first_lanes<DoubleMask>(pieces.count - i);
    const auto row = [&](const LinearPieces::Column& column)
                         LAMINA_LAMBDA { return load_unaligned<Double>(column.data() + i); };
    const Double depth = zero_unless(given, row(pieces.depth));
    const WeightLanes weights =
        weights_of(zero_unless(given, row(pieces.p)), zero_unless(given, row(pieces.q)), depth);
    store_unaligned(exp(-row(pieces.before)), pieces.transmittance.data() + i);
    store_unaligned(weights.front + weights.back, pieces.opacity.data() + i);
    store_unaligned(
        fma(weights.front, row(pieces.start_place), weights.back * row(pieces.end_place)),
        pieces.change.data() + i);
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

inline void weigh_pieces_of(LinearPieces& pieces) {
    using namespace reference;
    for (std::size_t i = 0; i < pieces.count; i += Double::lanes) weigh(pieces, i);
}

LAMINA_SIMD_END

#if LAMINA_ONCE
namespace lamina {
namespace {

// The position x of a piece, which lies in [0, 1]: any of its values is within an interval's
// opacity of the integral.
struct PiecePosition {
    using Value = double;
    const EmissionPiece& piece;

    double at(double t) const { return piece.position(t); }
    QuantityRange over(double, double) const { return {1, true}; }
    bool is_faint(double opacity, double allowed, double) const {
        return opacity <= negligible_opacity * allowed;
    }
    double spread(double opacity, double) const { return opacity; }
    double rounding(double in_front, double depth_to, double) const {
        return emission_rounding * in_front * depth_to;
    }
    double largest(double x) const { return std::abs(x); }
};

}  // namespace

EmissionIntegral integrate_emission(const EmissionPiece& piece, double error_per_t,
                                    double error_per_opacity) {
    // A boundary layer of optical depth 1e7 takes some 60 intervals.
    constexpr int most_intervals = 2000;
    const PiecePosition position{piece};
    NestedIntegral integral(piece, position, error_per_t, error_per_opacity, most_intervals);
    integral.add(0, 1, 0, piece.depth(1));
    return integral.result();
}

LAMINA_EXPORT(integrate_batch);
LAMINA_EXPORT(weigh_pieces_of);

void integrate_emission(PieceBatch& batch) {
    LAMINA_DISPATCH(integrate_batch)(batch);
}

void weigh_pieces(LinearPieces& pieces) {
    LAMINA_DISPATCH(weigh_pieces_of)(pieces);
}

}  // namespace lamina
#endif
