// SPDX-License-Identifier: Apache-2.0
#include "reference/integrate.h"

#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "optics/segment_integral.h"

#undef LAMINA_TARGET_FILE
#define LAMINA_TARGET_FILE "reference/integrate.cpp"
#include "simd/foreach_target.h"

#include "reference/cut-inl.h"
#include "simd/math-inl.h"

LAMINA_SIMD_BEGIN
namespace reference {

// Largest depth for which `terms` terms of Taylor's series of (exp(-depth) - 1) / depth are enough:
// the remainder is below depth^(terms + 1) / (terms + 2)! = 7e-18, 1e-16 and 5e-16.
template <std::size_t terms>
inline constexpr double series_limit = terms == 6   ? 0.016
                                       : terms == 8 ? 0.09
                                                    : 0.25;

// Returns (exp(-depth) - 1) / depth for depths up to series_limit<terms>.
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

constexpr std::size_t most_terms = 10;
constexpr double short_depth = series_limit<most_terms>;

// Depths that are up to short_depth in some lanes. A lane's result does not depend on the others.
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

// A rule's sums so far: of w = extinction exp(-depth), and of x w.
struct RuleSum {
    Double w, xw;

    LAMINA_INLINE void add(double weight, Double node_w, Double node_xw) {
        w = fma(weight, node_w, w);
        xw = fma(weight, node_xw, xw);
    }
};

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
    Cubics position_, extinction_, mean_depth_;  // mean_depth_(t) * t is the depth up to t
};

LAMINA_INLINE Double difference(const RuleSum& fine, const RuleSum& coarse, Double opacity) {
    return max(abs(fine.xw - coarse.xw), abs(fine.w - opacity));
}

LAMINA_INLINE DoubleMask given(const PieceBatch& batch, std::size_t i) {
    return first_lanes<DoubleMask>(batch.count - i);
}

template <typename Depth>
LAMINA_INLINE DoubleMask integrate_lanes(PieceBatch& batch, std::size_t i, const Depth& kind) {
    using namespace patterson;
    const PieceLanes<Depth> pieces(batch, i, kind);
    const Double depth = load_unaligned<Double>(batch.depth.data() + i);
    const Double opacity = kind.opacity(depth);
    const Double transmittance = exp(-load_unaligned<Double>(batch.before.data() + i));
    const Double span = load_unaligned<Double>(batch.color_span.data() + i);
    // The allowed error is given for the final colour. Dividing by transmittance and colour span
    // turns it into an error of the integral. No rule can be better than its rounding.
    const Double allowed = fma(batch.error_of_opacity, opacity * transmittance,
                               load_unaligned<Double>(batch.error_of_length.data() + i)) /
                           (transmittance * span);
    const Double enough = max(allowed, emission_rounding * depth);

    Double w[8], xw[8];
    RuleSum three{0, 0}, seven{0, 0}, fifteen{0, 0};
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
    // If the opacity is negligible, any x in [0, 1] will do: it errs by at most `opacity`.
    const DoubleMask faint = opacity <= negligible_opacity * allowed;
    value = select(faint, pieces.middle() * opacity, value);
    error = select(faint, opacity, error);
    store_unaligned(transmittance, batch.transmittance.data() + i);
    store_unaligned(opacity, batch.opacity.data() + i);
    store_unaligned(value, batch.value.data() + i);
    store_unaligned(error, batch.error.data() + i);
    return done | faint | beyond;
}

// Integrates a piece by bisection, after the rules have missed its allowed error.
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

// Computes both ends' weights as quadrature_weights() in optics/segment_integral.cpp, which derives
// the sums. p, q: extinction times length at the piece's start and end.
template <typename Depth>
LAMINA_INLINE WeightLanes weights_by_rule(const GaussRule& rule, Double p, Double q,
                                          const Depth& kind) {
    WeightLanes sum{0, 0};
    for (std::size_t i = 0; i < rule.points; ++i) {
        const double x = rule.x[i], rest = 1 - x;
        const Double depth_before = fma(x * (1 - x / 2), p, x * x / 2 * q);
        const Double depth_behind = fma(rest * rest / 2, p, rest * (1 + x) / 2 * q);
        const Double absorbed = kind.opacity(depth_before), weight(rule.weight[i]);
        sum.front = fma(weight, absorbed, sum.front);
        sum.back = fma(weight * (1 - absorbed), kind.opacity(depth_behind), sum.back);
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
    // Lanes behind the last piece hold arbitrary numbers.
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

inline void integrate_batch(PieceBatch& batch) {
    using namespace reference;
    const std::size_t lanes = Double::lanes;
    for (std::size_t i = 0; i < batch.count; i += lanes) {
        const Double depth = load_unaligned<Double>(batch.depth.data() + i);
        const DoubleMask is_short = depth <= short_depth;
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

// Sums of w and of f w, over a pair of nodes or over all nodes of a rule.
template <typename Value>
struct WeightedSum {
    double w = 0;
    Value value{0};
};

struct QuantityRange {
    double bound;  // bound on |f|; if f is a vector, on each component's
    bool smooth;   // no dip and no peak of f fits between the nodes of a rule
};

// Integrates f w over a piece, for a quantity f, by nested rules and bisection. The integral of w
// is known in closed form, which shows whether a rule misses a boundary layer. A Quantity has:
//   Value at(t): returns f.
//   QuantityRange over(from, to): returns the range of f on an interval.
//   bool is_faint(opacity, allowed, bound): tells whether f at the middle will do for an interval.
//   double spread(opacity, bound): returns the largest error of an interval with f at the middle.
//   double rounding(in_front, depth_to, bound): returns the rounding error of a rule's sums on an
//       interval that ends at depth_to and is seen through the transmittance in_front.
//   double largest(Value): returns the largest absolute value of a component.
template <class Quantity>
class NestedIntegral {
  public:
    using Value = typename Quantity::Value;

    // `most_intervals` limits the intervals examined. In further ones f in the middle must do.
    NestedIntegral(const EmissionPiece& piece, const Quantity& quantity, double error_per_t,
                   double error_per_opacity, int most_intervals)
        : piece_(piece),
          quantity_(quantity),
          error_per_t_(error_per_t),
          error_per_opacity_(error_per_opacity),
          budget_(most_intervals) {}

    // Adds the integral over from..to. depth_from, depth_to: the optical depths in front of these.
    void add(double from, double to, double depth_from, double depth_to) {
        const double in_front = std::exp(-depth_from);
        const double opacity = in_front * -std::expm1(depth_from - depth_to);
        const double allowed = error_per_t_ * (to - from) + error_per_opacity_ * opacity;
        const double middle = 0.5 * (from + to);
        const QuantityRange range = quantity_.over(from, to);
        const bool exhausted = --budget_ <= 0 || !(from < middle && middle < to);
        if (quantity_.is_faint(opacity, allowed, range.bound) || exhausted) {
            return accept(quantity_.at(middle) * opacity, quantity_.spread(opacity, range.bound));
        }
        if (range.smooth && depth_to - depth_from < resolvable_depth) {
            const double rounding = quantity_.rounding(in_front, depth_to, range.bound);
            if (try_rules(from, to, opacity, range.bound, std::max(allowed, rounding))) return;
        }
        const double depth_middle = piece_.depth(middle);
        add(from, middle, depth_from, depth_middle);
        add(middle, to, depth_middle, depth_to);
    }

    const Integral<Value>& result() const { return result_; }

  private:
    using Sum = WeightedSum<Value>;

    void accept(const Value& value, double error) {
        result_.value += value;
        result_.error += error;
    }

    bool try_rules(double from, double to, double opacity, double bound, double allowed) {
        Sum nodes[8];
        evaluate(from, to, 0, 4, nodes);
        const Sum three = by_rule(patterson::weight3, nodes, to - from);
        const Sum seven = by_rule(patterson::weight7, nodes, to - from);
        double error = difference(seven, three, opacity, bound);
        if (error <= allowed) {
            accept(seven.value, error);
            return true;
        }
        evaluate(from, to, 4, 8, nodes);
        const Sum fifteen = by_rule(patterson::weight15, nodes, to - from);
        error = difference(fifteen, seven, opacity, bound);
        if (error > allowed) return false;
        accept(fifteen.value, error);
        return true;
    }

    void evaluate(double from, double to, int first, int last, Sum (&nodes)[8]) const {
        const double middle = 0.5 * (from + to), length = to - from;
        for (int i = first; i < last; ++i) {
            const double offset = patterson::node[i] * length;
            for (const double t : {middle - offset, middle + offset}) {
                const double w = piece_.extinction(t) * std::exp(-piece_.depth(t));
                nodes[i].w += w;
                nodes[i].value += w * quantity_.at(t);
                if (i == 0) break;  // both are the centre
            }
        }
    }

    template <int count>
    static Sum by_rule(const double (&weights)[count], const Sum (&nodes)[8], double length) {
        Sum sum;
        for (int i = 0; i < count; ++i) {
            sum.w += weights[i] * nodes[i].w;
            sum.value += weights[i] * nodes[i].value;
        }
        return {sum.w * length, sum.value * length};
    }

    double difference(const Sum& fine, const Sum& coarse, double opacity, double bound) const {
        return std::max(quantity_.largest(fine.value - coarse.value),
                        bound * std::abs(fine.w - opacity));
    }

    const EmissionPiece& piece_;
    const Quantity& quantity_;
    double error_per_t_, error_per_opacity_;
    int budget_;  // number of intervals that may still be examined
    Integral<Value> result_;
};

// The quantity x. With any x in [0, 1] the result is off by at most an interval's opacity.
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

double max_component(const glm::dvec3& v) {
    return std::max({v.x, v.y, v.z});
}

glm::dvec3 value_at(const GradientAlong& gradient, double t) {
    return {gradient[0](t), gradient[1](t), gradient[2](t)};
}

Cubic dot(const GradientAlong& gradient, const glm::dvec3& direction) {
    Cubic sum;
    for (std::size_t i = 0; i < 4; ++i) {
        sum.c[i] = gradient[0].c[i] * direction.x + gradient[1].c[i] * direction.y +
                   gradient[2].c[i] * direction.z;
    }
    return sum;
}

struct GradientBall {
    glm::dvec3 center;
    double radius;
};

// Returns a ball around the four Bernstein coefficients, in whose convex hull the gradient stays.
GradientBall ball_of(const GradientAlong& gradient, double from, double to) {
    const double h = to - from;
    const glm::dvec3 start = value_at(gradient, from), end = value_at(gradient, to);
    glm::dvec3 second, third;
    for (int c = 0; c < 3; ++c) {
        const Cubic& component = gradient[c];
        second[c] = start[c] + component.slope(from) * h / 3;
        third[c] = end[c] - component.slope(to) * h / 3;
    }
    const glm::dvec3 center = value_at(gradient, 0.5 * (from + to));
    return {center, std::max({glm::distance(start, center), glm::distance(second, center),
                              glm::distance(third, center), glm::distance(end, center)})};
}

// Largest distance of gradients on an interval from the middle one, as a share of the middle one's
// length, for rules to be used: the effect's singularities are then at least half an interval away.
constexpr double most_growth = 0.5;
// Largest turn of the gradient on half an interval, in units of 1 / sqrt(power), the angle at which
// a highlight is exp(-1/2). One of three nodes on six such units is within 1.2 units of any peak.
constexpr double peak_widths = 3;

class LightEffect {
  public:
    using Value = glm::dvec3;

    LightEffect(const LitPiece& piece, const RayLights& lights)
        : piece_(piece),
          lights_(lights),
          largest_effect_(lights.largest_effect(
              max_component(glm::max(piece.color, piece.color + piece.color_change)))),
          most_turn_(lights.has_highlights()
                         ? std::min(most_growth, peak_widths / std::sqrt(lights.power()))
                         : most_growth) {}

    // Returns 0, the kinks in order, and 1.
    std::vector<double> smooth_intervals() const {
        std::vector<double> ends{0, 1};
        for (const RayLights::Direction& direction : lights_.directions()) {
            append_roots(direction.light, ends);
            if (lights_.has_highlights()) append_roots(direction.halfway, ends);
        }
        std::sort(ends.begin(), ends.end());
        ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
        return ends;
    }

    glm::dvec3 at(double t) const {
        const glm::dvec3 color = piece_.color + piece_.emission.position(t) * piece_.color_change;
        return lights_.effect(value_at(piece_.gradient, t)).on(color);
    }
    QuantityRange over(double from, double to) const {
        const GradientBall ball = ball_of(piece_.gradient, from, to);
        const double steepness = glm::length(ball.center);
        return {largest_effect_ * lights_.weight(steepness + ball.radius),
                ball.radius <= most_turn_ * steepness};
    }
    // The effect is between -bound and bound everywhere, so also in the middle.
    bool is_faint(double opacity, double allowed, double bound) const {
        return 2 * bound * opacity <= allowed;
    }
    double spread(double opacity, double bound) const { return 2 * bound * std::max(opacity, 0.0); }
    double rounding(double in_front, double depth_to, double bound) const {
        return emission_rounding * bound * in_front * (depth_to + 1);
    }
    double largest(const glm::dvec3& effect) const { return max_component(glm::abs(effect)); }

  private:
    void append_roots(const glm::dvec3& direction, std::vector<double>& roots) const {
        const Cubic cosine = dot(piece_.gradient, direction);
        const CubicTurns turns = turns_of(cosine);
        for (int i = 0; i < turns.count; ++i) {
            const double from = turns.t[i], to = turns.t[i + 1];
            const double start = cosine(from), end = cosine(to);
            if (!(std::min(start, end) < 0 && std::max(start, end) > 0)) continue;
            roots.push_back(std::clamp(solve_monotone(cosine, 0, from, to), from, to));
        }
    }

    const LitPiece& piece_;
    const RayLights& lights_;
    double largest_effect_;
    double most_turn_;  // largest radius of a ball for rules, as a share of its centre's length
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

LightIntegral integrate_light(const LitPiece& piece, const RayLights& lights, double error_per_t,
                              double error_per_opacity) {
    constexpr int most_intervals = 20000;
    const LightEffect effect(piece, lights);
    NestedIntegral integral(piece.emission, effect, error_per_t, error_per_opacity, most_intervals);
    const std::vector<double> ends = effect.smooth_intervals();
    double depth_from = 0;
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
        const double depth_to = piece.emission.depth(ends[i + 1]);
        integral.add(ends[i], ends[i + 1], depth_from, depth_to);
        depth_from = depth_to;
    }
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
