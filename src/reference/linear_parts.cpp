// SPDX-License-Identifier: Apache-2.0
// Vector form of integrate_segment() (optics/segment_integral.h).
#include "reference/linear_parts.h"

#include <limits>

#include "optics/gauss_rules.h"
#include "optics/segment_integral.h"

#undef LAMINA_TARGET_FILE
#define LAMINA_TARGET_FILE "reference/linear_parts.cpp"
#include "simd/foreach_target.h"

#include "reference/cubic-inl.h"
#include "reference/depth_lanes-inl.h"
#include "reference/rounds-inl.h"
#include "reference/transfer_intervals-inl.h"
#include "simd/members-inl.h"

LAMINA_SIMD_BEGIN
namespace reference {

// Optical depths of a part are limited to this, so that sums of them stay finite.
constexpr double largest_part_depth = 1e300;
constexpr double largest_scalar = std::numeric_limits<double>::max() / 4;

// A vector of segments on their way from front to back. `at` is the scalar where they are.
class LinearLanes {
  public:
    LAMINA_INLINE LinearLanes(const LinearBatch& segments, std::size_t first,
                              const IntervalColumns& columns)
        : search_(columns),
          active_(first_lanes<DoubleMask>(segments.count - first)),
          front_(finite(segments.front + first)),
          back_(finite(segments.back + first)),
          at_(front_),
          rises_(front_ <= back_),
          constant_(front_ == back_),
          interval_(search_.ahead(front_, rises_)) {}

    LAMINA_INLINE bool active() const { return any_of(active_); }

    // Goes on to the next knots or ends. The round gets the parts up to there.
    LAMINA_INLINE void advance(LinearRound& round) {
        const Double knot = search_.knot_ahead(interval_, rises_);
        const Double to = select(rises_, min(knot, back_), max(knot, back_));
        // Both differences are of the given doubles, so the share is accurate however close front
        // and back are.
        const Double share = (to - at_) / (back_ - front_);
        const DoubleMask has_length = constant_ | (to != at_);
        const DoubleMask kept = active_ & search_.shows(interval_) & has_length;
        round.kept = static_cast<std::uint8_t>(bits_of(kept));
        store(interval_, round.interval);
        store(at_, round.from);
        store(select(constant_, back_, to), round.to);
        store(select(constant_, 1, share), round.share);
        at_ = to;
        active_ = without(active_, constant_ | (at_ == back_));
        interval_ = select(active_, search_.beyond(interval_, rises_), interval_);
    }

  private:
    // Differences of larger scalars might overflow.
    LAMINA_INLINE Double finite(const double* from) const {
        return clamp(load_masked<Double>(active_, from), -largest_scalar, largest_scalar);
    }

    IntervalSearch search_;
    DoubleMask active_;
    Double front_, back_, at_;
    DoubleMask rises_, constant_;
    Long interval_;
};

// Appends a single round: most vectors of segments have no more.
LAMINA_INLINE void append_round(const LinearRound& round, std::size_t first_segment,
                                LinearParts& parts) {
    const KeptLanes kept(mask_of_bits<DoubleMask>(round.kept));
    const std::size_t end = parts.count;
    parts.make_room(end + Double::lanes);
    kept.store(iota<Long>(static_cast<std::int64_t>(first_segment)), parts.segment.data() + end);
    kept.store(load<Long>(round.interval), parts.interval.data() + end);
    kept.store(load<Double>(round.from), parts.from.data() + end);
    kept.store(load<Double>(round.to), parts.to.data() + end);
    kept.store(load<Double>(round.share), parts.depth.data() + end);  // until set_depths()
    parts.count += kept.count();
}

// The share of the way from an interval's lower knot to its upper one, and what is left of it.
struct PlaceLanes {
    Double from_lo, from_hi;

    LAMINA_INLINE PlaceLanes(Double value, Double lo, Double hi) {
        const auto share = [&](Double part) LAMINA_LAMBDA { return clamp(part / (hi - lo), 0, 1); };
        from_lo = share(value - lo);
        from_hi = share(hi - value);
    }
};

// Sets places, p, q and depth of a vector of parts, which have scalars in `from` and `to`, and
// their shares of the segments' lengths in `depth`.
LAMINA_INLINE void set_depths(const LinearBatch& segments, const IntervalColumns& columns,
                              std::size_t i, LinearParts& parts) {
    const IntervalSearch search(columns);
    const Long interval = load_unaligned<Long>(parts.interval.data() + i);
    const Double length = gather(segments.length, load_unaligned<Long>(parts.segment.data() + i)) *
                          load_unaligned<Double>(parts.depth.data() + i);
    const Double lo = search.of(columns.lo, interval), hi = search.of(columns.hi, interval);
    const Double at_lo = search.of(columns.extinction, interval);
    const Double at_hi = search.of(columns.extinction_end, interval);
    // No term is negative, so nothing cancels.
    const auto depth = [&](const PlaceLanes& place) LAMINA_LAMBDA {
        const Double mixed = fma(at_lo, place.from_hi, at_hi * place.from_lo);
        const Double extinction = select(at_lo == at_hi, at_lo, mixed);
        return min(extinction * length, largest_part_depth);
    };
    const PlaceLanes from(load_unaligned<Double>(parts.from.data() + i), lo, hi);
    const PlaceLanes to(load_unaligned<Double>(parts.to.data() + i), lo, hi);
    const Double p = depth(from), q = depth(to);
    store_unaligned(from.from_lo, parts.from.data() + i);
    store_unaligned(to.from_lo, parts.to.data() + i);
    store_unaligned(p, parts.p.data() + i);
    store_unaligned(q, parts.q.data() + i);
    store_unaligned(fma(0.5, p, 0.5 * q), parts.depth.data() + i);
}

struct WeightLanes {
    Double front, back;
};

// Vector form of the sums in optics/segment_integral.cpp, which says why they are written so.
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

// As piece_weights().
LAMINA_INLINE WeightLanes weights_of(Double p, Double q, Double depth) {
    const double most = largest_of(depth);
    if (!(most < largest_gauss_depth)) return closed_weights(p, q);
    const GaussRule& rule = gauss_rule(most);
    if (most <= series_limit<6>) return weights_by_rule(rule, p, q, ShortDepth<6>());
    if (most <= series_limit<8>) return weights_by_rule(rule, p, q, ShortDepth<8>());
    if (most <= series_limit<10>) return weights_by_rule(rule, p, q, ShortDepth<10>());
    return weights_by_rule(rule, p, q, AnyDepth());
}

LAMINA_INLINE void weigh(LinearParts& parts, std::size_t i) {
    // Lanes behind the last part hold anything.
    const DoubleMask given = first_lanes<DoubleMask>(parts.count - i);
    const auto row = [&](const LinearParts::Column& column)
                         LAMINA_LAMBDA { return load_unaligned<Double>(column.data() + i); };
    const Double depth = zero_unless(given, row(parts.depth));
    const WeightLanes weights =
        weights_of(zero_unless(given, row(parts.p)), zero_unless(given, row(parts.q)), depth);
    store_unaligned(exp(-row(parts.before)), parts.transmittance.data() + i);
    store_unaligned(weights.front + weights.back, parts.opacity.data() + i);
    store_unaligned(fma(weights.front, row(parts.from), weights.back * row(parts.to)),
                    parts.change.data() + i);
}

}  // namespace reference

// LAMINA_EXPORT takes functions of this namespace alone.
inline void append_parts_of(const LinearBatch& segments, const IntervalColumns& columns,
                            LinearParts& parts) {
    using namespace reference;
    const std::size_t lanes = Double::lanes, first = parts.count;
    const auto put = [&](std::size_t i, const LinearRound& round, std::size_t lane) {
        parts.interval[i] = round.interval[lane];
        parts.from[i] = round.from[lane];
        parts.to[i] = round.to[lane];
        parts.depth[i] = round.share[lane];  // until set_depths()
    };
    for (std::size_t i = 0; i < segments.count; i += lanes) {
        LinearLanes on_their_way(segments, i, columns);
        const std::size_t rounds = take_rounds(on_their_way, parts.rounds);
        if (rounds == 1) {
            append_round(parts.rounds[0], i, parts);
        } else {
            append_rounds(rounds, i, parts, put);
        }
    }
    for (std::size_t i = first; i < parts.count; i += lanes)
        set_depths(segments, columns, i, parts);
}

inline void weigh_parts_of(LinearParts& parts) {
    using namespace reference;
    for (std::size_t i = 0; i < parts.count; i += Double::lanes) weigh(parts, i);
}

LAMINA_SIMD_END

#if LAMINA_ONCE
namespace lamina {

LAMINA_EXPORT(append_parts_of);
LAMINA_EXPORT(weigh_parts_of);

void append_parts(const LinearBatch& segments, const IntervalColumns& intervals,
                  LinearParts& parts) {
    LAMINA_DISPATCH(append_parts_of)(segments, intervals, parts);
}

void weigh_parts(LinearParts& parts) {
    LAMINA_DISPATCH(weigh_parts_of)(parts);
}

}  // namespace lamina
#endif
