// SPDX-License-Identifier: Apache-2.0
// Segments are cut where their scalar crosses knots, in rounds: each round takes a vector of
// segments on to their next knots, or to where their scalars turn.
#include "reference/segment_pieces.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "reference/segment_pieces.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// After highway.h, which it needs for each target.
#include "reference/cubic_lanes-inl.h"
#include "reference/interval_search-inl.h"
#include "reference/rounds-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {
namespace reference {

// A vector of segments on their way from front to back. `at` is how far they are, `part_end` where
// their monotone part ends.
class SegmentLanes {
  public:
    HWY_INLINE SegmentLanes(const SegmentBatch& segments, std::size_t first,
                            const IntervalColumns& columns)
        : search_(columns),
          active_(hn::FirstN(Lanes(), segments.count - first)),
          lo_(load(segments.lo + first)),
          hi_(load(segments.hi + first)),
          at_(hn::Zero(Lanes())) {
        for (std::size_t power = 0; power < 4; ++power)
            scalar_.c[power] = load(segments.scalar[power] + first);
        // A segment in one interval is one piece. A constant may be a step's knot: there the value
        // itself decides the side.
        lowest_ = search_.above(lo_);
        const Mask whole =
            hn::And(hn::Le(hi_, search_.upper(lowest_)), hn::Not(scalar_.constant()));
        const Turns turns = turns_of(scalar_);
        part_end_ = hn::IfThenElse(whole, number(1), turns.first);
        next_end_ = turns.second;
        value_ = value_at(at_);
        begin_part();
        interval_ = where(whole, lowest_, interval_);
    }

    HWY_INLINE bool active() const { return !hn::AllFalse(Lanes(), active_); }

    // Goes on to the next knots or ends of parts. The round gets the pieces up to there.
    HWY_INLINE void advance(CutRound& round) {
        const Doubles knot = search_.knot_ahead(interval_, rises_);
        const Mask before_end = hn::Or(hn::And(rises_, hn::Lt(knot, part_value_)),
                                       hn::AndNot(rises_, hn::Gt(knot, part_value_)));
        const Mask crosses = hn::And(active_, before_end);
        const Doubles end = hn::IfThenElse(crosses, knot, part_value_);
        Doubles to = part_end_;
        if (!hn::AllFalse(Lanes(), crosses)) {
            const Mask away = hn::And(crosses, hn::Ne(knot, value_));
            const Doubles root = solve_monotone(scalar_, knot, at_, part_end_, away);
            to = hn::IfThenElse(crosses, hn::IfThenElse(away, root, at_), to);
        }
        fill(round, to, end);
        at_ = to;
        value_ = end;
        interval_ = where(crosses, search_.beyond(interval_, rises_), interval_);
        const Mask ended = hn::AndNot(crosses, active_);
        active_ = hn::And(active_, hn::Or(crosses, hn::Lt(at_, number(1))));
        if (!hn::AllFalse(Lanes(), hn::And(ended, active_))) next_part(ended);
    }

  private:
    // Lanes behind the last segment are 0.
    HWY_INLINE Doubles load(const double* from) const {
        return hn::MaskedLoad(active_, Lanes(), from);
    }

    HWY_INLINE Doubles value_at(Doubles t) const {
        return hn::Min(hn::Max(scalar_.at(t), lo_), hi_);
    }

    HWY_INLINE void begin_part() {
        part_value_ = value_at(part_end_);
        rises_ = hn::Le(value_, part_value_);
        interval_ = search_.onwards(lowest_, value_, rises_);
    }

    // Segments whose part goes on find the same direction and interval again.
    HWY_INLINE void next_part(Mask ended) {
        part_end_ = hn::IfThenElse(ended, next_end_, part_end_);
        next_end_ = hn::IfThenElse(ended, number(1), next_end_);
        begin_part();
    }

    HWY_INLINE void fill(CutRound& round, Doubles to, Doubles end) const {
        const Lanes d;
        const Mask kept = hn::And(hn::And(active_, search_.shows(interval_)), hn::Lt(at_, to));
        hn::StoreMaskBits(d, kept, round.kept);
        hn::Store(interval_, NumberLanes(), round.interval);
        hn::Store(at_, d, round.from);
        hn::Store(to, d, round.to);
        hn::Store(value_, d, round.start);
        hn::Store(end, d, round.end);
    }

    IntervalSearch search_;
    Mask active_;
    Doubles lo_, hi_;
    Cubics scalar_;
    Doubles at_, value_;
    Doubles part_end_, next_end_, part_value_;
    Mask rises_;
    Numbers lowest_, interval_;  // the one of lo_, and of the piece that is next
};

// Sets the optics of a vector of pieces. Extinction is computed from the nearer knot, so that few
// digits are lost where a steep interval ends at extinction 0.
HWY_INLINE void set_optics(const SegmentBatch& segments, const IntervalColumns& columns,
                           double error_per_length, std::size_t i, PieceBatch& pieces) {
    const Lanes d;
    const IntervalSearch search(columns);
    const Numbers segment = hn::LoadU(NumberLanes(), pieces.segment.data() + i);
    const Numbers interval = hn::LoadU(NumberLanes(), pieces.interval.data() + i);
    const Doubles from = hn::LoadU(d, pieces.from.data() + i);
    const Doubles to = hn::LoadU(d, pieces.to.data() + i);
    Cubics whole;
    for (std::size_t power = 0; power < 4; ++power)
        whole.c[power] = hn::GatherIndex(d, segments.scalar[power], segment);
    const Cubics scalar = part_of(whole, from, to, hn::LoadU(d, pieces.start.data() + i),
                                  hn::LoadU(d, pieces.end.data() + i));
    const Doubles length = hn::Mul(hn::GatherIndex(d, segments.length, segment), hn::Sub(to, from));
    const Doubles inverse = search.of(columns.inverse_width, interval);
    const Doubles at_lo = search.of(columns.extinction, interval);
    const Doubles change = search.of(columns.extinction_change, interval);
    const Doubles from_lo = hn::Mul(hn::Sub(scalar.c[0], search.of(columns.lo, interval)), inverse);
    const Doubles from_hi = hn::Mul(hn::Sub(search.of(columns.hi, interval), scalar.c[0]), inverse);
    const Doubles first =
        hn::IfThenElse(hn::Lt(from_lo, from_hi), hn::MulAdd(change, from_lo, at_lo),
                       hn::NegMulAdd(change, from_hi, hn::Add(at_lo, change)));
    Cubics position, extinction;
    position.c[0] = from_lo;
    extinction.c[0] = hn::Mul(hn::Max(first, hn::Zero(d)), length);
    for (std::size_t power = 1; power < 4; ++power) {
        position.c[power] = hn::Mul(scalar.c[power], inverse);
        extinction.c[power] = hn::Mul(hn::Mul(change, position.c[power]), length);
    }
    Doubles depth = hn::Zero(d);
    for (std::size_t power = 4; power-- > 0;) {
        hn::StoreU(position.c[power], d, pieces.position[power].data() + i);
        hn::StoreU(extinction.c[power], d, pieces.extinction[power].data() + i);
        depth = hn::Add(depth,
                        hn::Mul(extinction.c[power], number(1 / static_cast<double>(power + 1))));
    }
    hn::StoreU(hn::Max(depth, hn::Zero(d)), d, pieces.depth.data() + i);
    hn::StoreU(hn::Mul(number(error_per_length), length), d, pieces.error_of_length.data() + i);
    hn::StoreU(search.of(columns.color_span, interval), d, pieces.color_span.data() + i);
}

}  // namespace reference

// HWY_EXPORT takes functions of this namespace alone.
inline void append_pieces_of(const SegmentBatch& segments, const IntervalColumns& columns,
                             double error_per_length, PieceBatch& pieces) {
    using namespace reference;
    const std::size_t lanes = hn::Lanes(Lanes()), first = pieces.count;
    const auto store = [&](std::size_t i, const CutRound& round, std::size_t lane) HWY_ATTR {
        pieces.interval[i] = round.interval[lane];
        pieces.from[i] = round.from[lane];
        pieces.to[i] = round.to[lane];
        pieces.start[i] = round.start[lane];
        pieces.end[i] = round.end[lane];
    };
    for (std::size_t i = 0; i < segments.count; i += lanes) {
        SegmentLanes on_their_way(segments, i, columns);
        append_rounds(take_rounds(on_their_way, pieces.rounds), i, pieces, store);
    }
    for (std::size_t i = first; i < pieces.count; i += lanes)
        set_optics(segments, columns, error_per_length, i, pieces);
}

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lamina {

HWY_EXPORT(append_pieces_of);

void append_pieces(const SegmentBatch& segments, const TransferIntervals& transfer,
                   double error_per_length, PieceBatch& pieces) {
    HWY_DYNAMIC_DISPATCH(append_pieces_of)
    (segments, transfer.columns(), error_per_length, pieces);
}

}  // namespace lamina
#endif
