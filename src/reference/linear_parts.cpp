// SPDX-License-Identifier: Apache-2.0
// Vector form of integrate_segment() (optics/segment_integral.h).
#include "reference/linear_parts.h"

#include <limits>

#include "optics/gauss_rules.h"
#include "optics/segment_integral.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "reference/linear_parts.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// After highway.h, which it needs for each target.
#include "reference/cubic_lanes-inl.h"
#include "reference/depth_lanes-inl.h"
#include "reference/interval_search-inl.h"
#include "reference/rounds-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {
namespace reference {

// Optical depths of a part are limited to this, so that sums of them stay finite.
constexpr double largest_part_depth = 1e300;
constexpr double largest_scalar = std::numeric_limits<double>::max() / 4;

// A vector of segments on their way from front to back. `at` is the scalar where they are.
class LinearLanes {
  public:
    HWY_INLINE LinearLanes(const LinearBatch& segments, std::size_t first,
                           const IntervalColumns& columns)
        : search_(columns),
          active_(hn::FirstN(Lanes(), segments.count - first)),
          front_(load(segments.front + first)),
          back_(load(segments.back + first)),
          at_(front_),
          rises_(hn::Le(front_, back_)),
          constant_(hn::Eq(front_, back_)),
          interval_(search_.ahead(front_, rises_)) {}

    HWY_INLINE bool active() const { return !hn::AllFalse(Lanes(), active_); }

    // Goes on to the next knots or ends. The round gets the parts up to there.
    HWY_INLINE void advance(LinearRound& round) {
        const Lanes d;
        const Doubles knot = search_.knot_ahead(interval_, rises_);
        const Doubles to = hn::IfThenElse(rises_, hn::Min(knot, back_), hn::Max(knot, back_));
        // Both differences are of the given doubles, so the share is accurate however close front
        // and back are.
        const Doubles share = hn::Div(hn::Sub(to, at_), hn::Sub(back_, front_));
        const Mask has_length = hn::Or(constant_, hn::Ne(to, at_));
        const Mask kept = hn::And(hn::And(active_, search_.shows(interval_)), has_length);
        hn::StoreMaskBits(d, kept, round.kept);
        hn::Store(interval_, NumberLanes(), round.interval);
        hn::Store(at_, d, round.from);
        hn::Store(hn::IfThenElse(constant_, back_, to), d, round.to);
        hn::Store(hn::IfThenElse(constant_, number(1), share), d, round.share);
        at_ = to;
        active_ = hn::AndNot(hn::Or(constant_, hn::Eq(at_, back_)), active_);
        interval_ = where(active_, search_.beyond(interval_, rises_), interval_);
    }

  private:
    // Differences of larger scalars might overflow.
    HWY_INLINE Doubles load(const double* from) const {
        const Doubles limit = number(largest_scalar);
        const Doubles values = hn::MaskedLoad(active_, Lanes(), from);
        return hn::Min(hn::Max(values, hn::Neg(limit)), limit);
    }

    IntervalSearch search_;
    Mask active_;
    Doubles front_, back_, at_;
    Mask rises_, constant_;
    Numbers interval_;
};

// Appends a single round: most vectors of segments have no more.
HWY_INLINE void append_round(const LinearRound& round, std::size_t first_segment,
                             LinearParts& parts) {
    const Lanes d;
    const NumberLanes n;
    const KeptLanes kept(hn::LoadMaskBits(d, round.kept));
    const std::size_t end = parts.count;
    parts.make_room(end + hn::Lanes(d));
    kept.store(hn::Iota(n, static_cast<std::int64_t>(first_segment)), parts.segment.data() + end);
    kept.store(hn::Load(n, round.interval), parts.interval.data() + end);
    kept.store(hn::Load(d, round.from), parts.from.data() + end);
    kept.store(hn::Load(d, round.to), parts.to.data() + end);
    kept.store(hn::Load(d, round.share), parts.depth.data() + end);  // until set_depths()
    parts.count += kept.count();
}

// The share of the way from an interval's lower knot to its upper one, and what is left of it.
struct PlaceLanes {
    Doubles from_lo, from_hi;

    HWY_INLINE PlaceLanes(Doubles value, Doubles lo, Doubles hi) {
        const auto share = [&](Doubles part) HWY_ATTR {
            return hn::Min(hn::Max(hn::Div(part, hn::Sub(hi, lo)), hn::Zero(Lanes())), number(1));
        };
        from_lo = share(hn::Sub(value, lo));
        from_hi = share(hn::Sub(hi, value));
    }
};

// Sets places, p, q and depth of a vector of parts, which have scalars in `from` and `to`, and
// their shares of the segments' lengths in `depth`.
HWY_INLINE void set_depths(const LinearBatch& segments, const IntervalColumns& columns,
                           std::size_t i, LinearParts& parts) {
    const Lanes d;
    const NumberLanes n;
    const IntervalSearch search(columns);
    const Numbers interval = hn::LoadU(n, parts.interval.data() + i);
    const Doubles length =
        hn::Mul(hn::GatherIndex(d, segments.length, hn::LoadU(n, parts.segment.data() + i)),
                hn::LoadU(d, parts.depth.data() + i));
    const Doubles lo = search.of(columns.lo, interval), hi = search.of(columns.hi, interval);
    const Doubles at_lo = search.of(columns.extinction, interval);
    const Doubles at_hi = search.of(columns.extinction_end, interval);
    // No term is negative, so nothing cancels.
    const auto depth = [&](const PlaceLanes& place) HWY_ATTR {
        const Doubles mixed = hn::MulAdd(at_lo, place.from_hi, hn::Mul(at_hi, place.from_lo));
        const Doubles extinction = hn::IfThenElse(hn::Eq(at_lo, at_hi), at_lo, mixed);
        return hn::Min(hn::Mul(extinction, length), number(largest_part_depth));
    };
    const PlaceLanes from(hn::LoadU(d, parts.from.data() + i), lo, hi);
    const PlaceLanes to(hn::LoadU(d, parts.to.data() + i), lo, hi);
    const Doubles p = depth(from), q = depth(to);
    hn::StoreU(from.from_lo, d, parts.from.data() + i);
    hn::StoreU(to.from_lo, d, parts.to.data() + i);
    hn::StoreU(p, d, parts.p.data() + i);
    hn::StoreU(q, d, parts.q.data() + i);
    hn::StoreU(hn::MulAdd(number(0.5), p, hn::Mul(number(0.5), q)), d, parts.depth.data() + i);
}

struct WeightLanes {
    Doubles front, back;
};

// Vector form of the sums in optics/segment_integral.cpp, which says why they are written so.
template <typename Depth>
HWY_INLINE WeightLanes weights_by_rule(const GaussRule& rule, Doubles p, Doubles q,
                                       const Depth& kind) {
    const Lanes d;
    WeightLanes sum{hn::Zero(d), hn::Zero(d)};
    for (std::size_t i = 0; i < rule.points; ++i) {
        const double x = rule.x[i], rest = 1 - x;
        const Doubles before =
            hn::MulAdd(number(x * (1 - x / 2)), p, hn::Mul(number(x * x / 2), q));
        const Doubles behind =
            hn::MulAdd(number(rest * rest / 2), p, hn::Mul(number(rest * (1 + x) / 2), q));
        const Doubles absorbed = kind.opacity(before), weight = number(rule.weight[i]);
        sum.front = hn::MulAdd(weight, absorbed, sum.front);
        sum.back = hn::MulAdd(hn::Mul(weight, hn::Sub(number(1), absorbed)), kind.opacity(behind),
                              sum.back);
    }
    return sum;
}

HWY_INLINE WeightLanes closed_weights(Doubles p, Doubles q) {
    const Lanes d;
    alignas(64) double ps[longest_vector], qs[longest_vector], fronts[longest_vector],
        backs[longest_vector];
    hn::Store(p, d, ps);
    hn::Store(q, d, qs);
    for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane) {
        const PieceWeights weights = piece_weights(ps[lane], qs[lane]);
        fronts[lane] = weights.front;
        backs[lane] = weights.back;
    }
    return {hn::Load(d, fronts), hn::Load(d, backs)};
}

// As piece_weights().
HWY_INLINE WeightLanes weights_of(Doubles p, Doubles q, Doubles depth) {
    const double most = hn::GetLane(hn::MaxOfLanes(Lanes(), depth));
    if (!(most < largest_gauss_depth)) return closed_weights(p, q);
    const GaussRule& rule = gauss_rule(most);
    if (most <= series_limit<6>) return weights_by_rule(rule, p, q, ShortDepth<6>());
    if (most <= series_limit<8>) return weights_by_rule(rule, p, q, ShortDepth<8>());
    if (most <= series_limit<10>) return weights_by_rule(rule, p, q, ShortDepth<10>());
    return weights_by_rule(rule, p, q, AnyDepth());
}

HWY_INLINE void weigh(LinearParts& parts, std::size_t i) {
    const Lanes d;
    // Lanes behind the last part hold anything.
    const Mask given = hn::FirstN(d, parts.count - i);
    const auto load = [&](const LinearParts::Column& column)
                          HWY_ATTR { return hn::LoadU(d, column.data() + i); };
    const Doubles depth = hn::IfThenElseZero(given, load(parts.depth));
    const WeightLanes weights = weights_of(hn::IfThenElseZero(given, load(parts.p)),
                                           hn::IfThenElseZero(given, load(parts.q)), depth);
    hn::StoreU(hn::Exp(d, hn::Neg(load(parts.before))), d, parts.transmittance.data() + i);
    hn::StoreU(hn::Add(weights.front, weights.back), d, parts.opacity.data() + i);
    hn::StoreU(hn::MulAdd(weights.front, load(parts.from), hn::Mul(weights.back, load(parts.to))),
               d, parts.change.data() + i);
}

}  // namespace reference

// HWY_EXPORT takes functions of this namespace alone.
inline void append_parts_of(const LinearBatch& segments, const IntervalColumns& columns,
                            LinearParts& parts) {
    using namespace reference;
    const std::size_t lanes = hn::Lanes(Lanes()), first = parts.count;
    const auto store = [&](std::size_t i, const LinearRound& round, std::size_t lane) HWY_ATTR {
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
            append_rounds(rounds, i, parts, store);
        }
    }
    for (std::size_t i = first; i < parts.count; i += lanes)
        set_depths(segments, columns, i, parts);
}

inline void weigh_parts_of(LinearParts& parts) {
    using namespace reference;
    for (std::size_t i = 0; i < parts.count; i += hn::Lanes(Lanes())) weigh(parts, i);
}

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lamina {

HWY_EXPORT(append_parts_of);
HWY_EXPORT(weigh_parts_of);

void append_parts(const LinearBatch& segments, const IntervalColumns& intervals,
                  LinearParts& parts) {
    HWY_DYNAMIC_DISPATCH(append_parts_of)(segments, intervals, parts);
}

void weigh_parts(LinearParts& parts) {
    HWY_DYNAMIC_DISPATCH(weigh_parts_of)(parts);
}

}  // namespace lamina
#endif
