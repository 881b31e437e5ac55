// SPDX-License-Identifier: Apache-2.0
// Segments are cut where their scalar crosses knots, in rounds: each round takes a vector of
// segments on to their next knots, or to where their scalars turn.
#include "reference/segment_pieces.h"

#undef LAMINA_TARGET_FILE
#define LAMINA_TARGET_FILE "reference/segment_pieces.cpp"
#include "simd/foreach_target.h"

#include "reference/cubic-inl.h"
#include "reference/rounds-inl.h"
#include "reference/transfer_intervals-inl.h"

LAMINA_SIMD_BEGIN
namespace reference {

// A vector of segments on their way from front to back. `at` is how far they are, `part_end` where
// their monotone part ends.
class SegmentLanes {
  public:
    LAMINA_INLINE SegmentLanes(const SegmentBatch& segments, std::size_t first,
                               const IntervalColumns& columns)
        : search_(columns),
          active_(first_lanes<DoubleMask>(segments.count - first)),
          lo_(given(segments.lo + first)),
          hi_(given(segments.hi + first)),
          at_(0) {
        for (std::size_t power = 0; power < 4; ++power)
            scalar_.c[power] = given(segments.scalar[power] + first);
        // A segment in one interval is one piece. A constant may be a step's knot: there the value
        // itself decides the side.
        lowest_ = search_.above(lo_);
        const DoubleMask whole = (hi_ <= search_.upper(lowest_)) & !scalar_.constant();
        const Turns turns = turns_of(scalar_);
        part_end_ = select(whole, 1, turns.first);
        next_end_ = turns.second;
        value_ = value_at(at_);
        begin_part();
        interval_ = select(whole, lowest_, interval_);
    }

    LAMINA_INLINE bool active() const { return any_of(active_); }

    // Goes on to the next knots or ends of parts. The round gets the pieces up to there.
    LAMINA_INLINE void advance(CutRound& round) {
        const Double knot = search_.knot_ahead(interval_, rises_);
        const DoubleMask before_end =
            (rises_ & (knot < part_value_)) | without(knot > part_value_, rises_);
        const DoubleMask crosses = active_ & before_end;
        const Double end = select(crosses, knot, part_value_);
        Double to = part_end_;
        if (any_of(crosses)) {
            const DoubleMask away = crosses & (knot != value_);
            const Double root = solve_monotone(scalar_, knot, at_, part_end_, away);
            to = select(crosses, select(away, root, at_), to);
        }
        fill(round, to, end);
        at_ = to;
        value_ = end;
        interval_ = select(crosses, search_.beyond(interval_, rises_), interval_);
        const DoubleMask ended = without(active_, crosses);
        active_ = active_ & (crosses | (at_ < 1));
        if (any_of(ended & active_)) next_part(ended);
    }

  private:
    // Lanes behind the last segment are 0.
    LAMINA_INLINE Double given(const double* from) const {
        return load_masked<Double>(active_, from);
    }

    LAMINA_INLINE Double value_at(Double t) const { return clamp(scalar_.at(t), lo_, hi_); }

    LAMINA_INLINE void begin_part() {
        part_value_ = value_at(part_end_);
        rises_ = value_ <= part_value_;
        interval_ = search_.onwards(lowest_, value_, rises_);
    }

    // Segments whose part goes on find the same direction and interval again.
    LAMINA_INLINE void next_part(DoubleMask ended) {
        part_end_ = select(ended, next_end_, part_end_);
        next_end_ = select(ended, 1, next_end_);
        begin_part();
    }

    LAMINA_INLINE void fill(CutRound& round, Double to, Double end) const {
        const DoubleMask kept = active_ & search_.shows(interval_) & (at_ < to);
        round.kept = static_cast<std::uint8_t>(bits_of(kept));
        store(interval_, round.interval);
        store(at_, round.from);
        store(to, round.to);
        store(value_, round.start);
        store(end, round.end);
    }

    IntervalSearch search_;
    DoubleMask active_;
    Double lo_, hi_;
    Cubics scalar_;
    Double at_, value_;
    Double part_end_, next_end_, part_value_;
    DoubleMask rises_;
    Long lowest_, interval_;  // the one of lo_, and of the piece that is next
};

// Sets the optics of a vector of pieces. Extinction is computed from the nearer knot, so that few
// digits are lost where a steep interval ends at extinction 0.
LAMINA_INLINE void set_optics(const SegmentBatch& segments, const IntervalColumns& columns,
                              double error_per_length, std::size_t i, PieceBatch& pieces) {
    const IntervalSearch search(columns);
    const Long segment = load_unaligned<Long>(pieces.segment.data() + i);
    const Long interval = load_unaligned<Long>(pieces.interval.data() + i);
    const Double from = load_unaligned<Double>(pieces.from.data() + i);
    const Double to = load_unaligned<Double>(pieces.to.data() + i);
    Cubics whole;
    for (std::size_t power = 0; power < 4; ++power)
        whole.c[power] = gather(segments.scalar[power], segment);
    const Cubics scalar = part_of(whole, from, to, load_unaligned<Double>(pieces.start.data() + i),
                                  load_unaligned<Double>(pieces.end.data() + i));
    const Double length = gather(segments.length, segment) * (to - from);
    const Double inverse = search.of(columns.inverse_width, interval);
    const Double at_lo = search.of(columns.extinction, interval);
    const Double change = search.of(columns.extinction_change, interval);
    const Double from_lo = (scalar.c[0] - search.of(columns.lo, interval)) * inverse;
    const Double from_hi = (search.of(columns.hi, interval) - scalar.c[0]) * inverse;
    const Double first = select(from_lo < from_hi, fma(change, from_lo, at_lo),
                                fnma(change, from_hi, at_lo + change));
    Cubics position, extinction;
    position.c[0] = from_lo;
    extinction.c[0] = max(first, 0) * length;
    for (std::size_t power = 1; power < 4; ++power) {
        position.c[power] = scalar.c[power] * inverse;
        extinction.c[power] = change * position.c[power] * length;
    }
    Double depth = Double(0);
    for (std::size_t power = 4; power-- > 0;) {
        store_unaligned(position.c[power], pieces.position[power].data() + i);
        store_unaligned(extinction.c[power], pieces.extinction[power].data() + i);
        depth += extinction.c[power] * (1 / static_cast<double>(power + 1));
    }
    store_unaligned(max(depth, 0), pieces.depth.data() + i);
    store_unaligned(error_per_length * length, pieces.error_of_length.data() + i);
    store_unaligned(search.of(columns.color_span, interval), pieces.color_span.data() + i);
}

}  // namespace reference

// LAMINA_EXPORT takes functions of this namespace alone.
inline void append_pieces_of(const SegmentBatch& segments, const IntervalColumns& columns,
                             double error_per_length, PieceBatch& pieces) {
    using namespace reference;
    const std::size_t lanes = Double::lanes, first = pieces.count;
    const auto put = [&](std::size_t i, const CutRound& round, std::size_t lane) {
        pieces.interval[i] = round.interval[lane];
        pieces.from[i] = round.from[lane];
        pieces.to[i] = round.to[lane];
        pieces.start[i] = round.start[lane];
        pieces.end[i] = round.end[lane];
    };
    for (std::size_t i = 0; i < segments.count; i += lanes) {
        SegmentLanes on_their_way(segments, i, columns);
        append_rounds(take_rounds(on_their_way, pieces.rounds), i, pieces, put);
    }
    for (std::size_t i = first; i < pieces.count; i += lanes)
        set_optics(segments, columns, error_per_length, i, pieces);
}

LAMINA_SIMD_END

#if LAMINA_ONCE
namespace lamina {

LAMINA_EXPORT(append_pieces_of);

void append_pieces(const SegmentBatch& segments, const TransferIntervals& transfer,
                   double error_per_length, PieceBatch& pieces) {
    LAMINA_DISPATCH(append_pieces_of)
    (segments, transfer.columns(), error_per_length, pieces);
}

}  // namespace lamina
#endif
