// SPDX-License-Identifier: Apache-2.0
// Vector form of how shaders/slicing/segment.glsl reads the pre-integration table.
#if defined(LAMINA_EXECUTORS_TILE_PREINTEGRATION_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_EXECUTORS_TILE_PREINTEGRATION_INL_H_
#undef LAMINA_EXECUTORS_TILE_PREINTEGRATION_INL_H_
#else
#define LAMINA_EXECUTORS_TILE_PREINTEGRATION_INL_H_
#endif

#include "executors/tile_table-inl.h"
#include "tiles/linear_segment-inl.h"
#include "tiles/opacity-inl.h"

LAMINA_SIMD_BEGIN

// A scalar's interval and its node coordinate in the table.
struct TablePlace {
    Int interval;
    Float node;
};

template <Lookup kind>
LAMINA_INLINE TablePlace table_place(const TileTransfer& transfer, Float scalar) {
    const Int interval = find_interval<kind>(transfer, scalar);
    const Float share = share_of_interval<kind>(transfer, interval, scalar);
    return {interval, share * look_up<kind>(transfer.nodes, interval) +
                          look_up<kind>(transfer.first_node, interval)};
}

// Associated colour and optical depth of the front of a segment, behind which the next run is
// added.
struct RunSum {
    Float color[3];
    Float depth;
};
// With front parts of colour and opacity (optics/front_parts.h), as colour is: associated, or not.
struct LitSum : RunSum {
    Float front_color[3];
    Float front_share;
};
template <bool lit>
using SumOf = std::conditional_t<lit, LitSum, RunSum>;

template <bool lit>
LAMINA_INLINE SumOf<lit> no_sum() {
    const Float zero(0);
    if constexpr (lit)
        return {{{zero, zero, zero}, zero}, {zero, zero, zero}, zero};
    else
        return {{zero, zero, zero}, zero};
}

// Adds a run with the given table entry behind `sum`. Of lit segments `share` is the run's share
// of the segment's length and `left` that of what is behind it.
struct RunShares {
    Float share, left;
};
template <bool lit>
LAMINA_INLINE void add_entry(const EntryOf<lit>& entry, Float length, const RunShares& shares,
                             SumOf<lit>& sum) {
    const Float depth = entry.extinction * length;
    const FloatMask seen = depth > 0;
    const Float transmitted = exp_of(-sum.depth);
    const Float weight =
        zero_unless(seen, transmitted * opacity_from_depth(depth) / entry.extinction);
    for (int channel = 0; channel < 3; ++channel)
        sum.color[channel] += weight * entry.emission[channel];
    if constexpr (lit) {
        const auto add = [&](Float whole, Float front, Float& to) LAMINA_LAMBDA {
            const Float seen_part = shares.left * whole + shares.share * front;
            to += weight * seen_part;
        };
        for (int channel = 0; channel < 3; ++channel)
            add(entry.emission[channel], entry.front_emission[channel], sum.front_color[channel]);
        add(entry.extinction, entry.front_extinction, sum.front_share);
    }
    sum.depth += depth;
}

struct RunEnds {
    Float front, back, length;
    TablePlace front_place, back_place;
};

// The stretch of a segment that one look-up integrates.
struct TableRun {
    TableCell cell;
    Float length;
};

// A segment before the table is looked up. Where the segment crosses ends of intervals, it is cut
// at the first and at the last of these. `first` is the stretch before the first cut, or all of the
// segment. Most segments that are cut cross one end only and have nothing `between`.
struct Segment {
    TableRun first, between, last;
    Float length;
    FloatMask seen, cut, parted;  // shows something; is cut; has something between
    bool some_cut;
};

LAMINA_INLINE std::int32_t table_nodes(const TileTransfer& transfer) {
    return static_cast<std::int32_t>(transfer.table->nodes.size());
}

// Sets first, between and last in the lanes that are cut.
template <Lookup kind>
LAMINA_INLINE void cut_segment(const TileTransfer& transfer, const RunEnds& run, Segment& segment) {
    const std::int32_t nodes = table_nodes(transfer);
    const FloatMask rising = run.front < run.back;
    const Int front_interval = run.front_place.interval, back_interval = run.back_place.interval;
    const Int first = select(rising, front_interval + 1, front_interval);
    const Int last = select(rising, back_interval, back_interval + 1);
    const Float first_end = look_up<kind>(transfer.left_end, first);
    const Float last_end = look_up<kind>(transfer.left_end, last);
    const auto right_node = [&](Int interval) {
        return look_up<kind>(transfer.first_node, interval) +
               look_up<kind>(transfer.nodes, interval);
    };
    const Float back_end = select(rising, look_up<kind>(transfer.first_node, back_interval),
                                  right_node(back_interval));
    const Float front_end = select(rising, right_node(front_interval),
                                   look_up<kind>(transfer.first_node, front_interval));
    const Float per_scalar = run.length / (run.back - run.front);
    const auto length = [&](Float from, Float to)
                            LAMINA_LAMBDA { return (to - from) * per_scalar; };
    const FloatMask cut = segment.cut;
    segment.parted = cut & (first_end != last_end);
    segment.first = {
        table_cell(nodes, run.front_place.node, select(cut, front_end, run.back_place.node)),
        select(cut, length(run.front, first_end), segment.first.length)};
    segment.between = {table_cell(nodes, look_up<kind>(transfer.first_node, first), back_end),
                       length(first_end, last_end)};
    segment.last = {table_cell(nodes, back_end, run.back_place.node), length(last_end, run.back)};
}

// Replaces the intervals of lanes that are not cut, so that these do not read beyond the last
// interval.
LAMINA_INLINE RunEnds ends_of_cut(const RunEnds& run, FloatMask cut) {
    RunEnds ends = run;
    ends.front_place.interval = zero_unless(cut, ends.front_place.interval);
    ends.back_place.interval = zero_unless(cut, ends.back_place.interval);
    ends.length = zero_unless(cut, ends.length);
    ends.back = select(cut, ends.back, ends.front + 1.0f);
    return ends;
}

template <Lookup kind>
LAMINA_INLINE Segment segment_of(const TileTransfer& transfer, Float front, Float back,
                                 Float length, FloatMask seen) {
    const RunEnds ends{front, back, length, table_place<kind>(transfer, front),
                       table_place<kind>(transfer, back)};
    Segment segment;
    segment.length = segment.first.length = length;
    segment.seen = seen;
    segment.cut = (ends.front_place.interval != ends.back_place.interval) & seen;
    segment.some_cut = kind != Lookup::one && any_of(segment.cut);
    if (segment.some_cut) {
        cut_segment<kind>(transfer, ends_of_cut(ends, segment.cut), segment);
    } else {
        segment.first.cell =
            table_cell(table_nodes(transfer), ends.front_place.node, ends.back_place.node);
    }
    return segment;
}

// The table entries of `first` and `last` of a segment.
template <bool lit>
struct SegmentEntries {
    EntryOf<lit> first, last;
};

// Optical depth of the lanes that are cut. The values of other lanes have no meaning.
LAMINA_INLINE Float depth_of_parts(const TileTransfer& transfer, const Segment& segment,
                                   bool some_parted) {
    Float depth(0);
    const auto add = [&](const TableRun& run) LAMINA_LAMBDA {
        depth += table_extinction(*transfer.table, run.cell) * run.length;
    };
    add(segment.first);
    if (some_parted) add(segment.between);
    add(segment.last);
    return depth;
}

// Associated colour and optical depth of the lanes that are cut. The values of other lanes have no
// meaning.
template <bool lit>
LAMINA_INLINE SumOf<lit> sum_of_parts(const TileTransfer& transfer, const Segment& segment,
                                      const SegmentEntries<lit>& entries) {
    SumOf<lit> sum = no_sum<lit>();
    RunShares first, between, last;
    if constexpr (lit) {
        const Float inverse = 1.0f / segment.length;
        first.share = segment.first.length * inverse;
        last.share = segment.last.length * inverse;
        last.left = Float(0);
        between.share = segment.between.length * inverse;
        between.left = last.share;
        first.left = between.share + last.share;
    }
    add_entry<lit>(entries.first, segment.first.length, first, sum);
    if (any_of(segment.parted)) {
        const TableRun& run = segment.between;
        add_entry<lit>(table_entry<lit>(transfer, run.cell, run.length, segment.parted), run.length,
                       between, sum);
    }
    add_entry<lit>(entries.last, segment.last.length, last, sum);
    return sum;
}

// Calls visit(number of one, the same of the other) for what a sum has of colours.
template <bool lit, class Visit>
LAMINA_INLINE void visit_colors(SumOf<lit>& one, const SumOf<lit>& other, const Visit& visit) {
    for (int channel = 0; channel < 3; ++channel) visit(one.color[channel], other.color[channel]);
    if constexpr (lit) {
        for (int channel = 0; channel < 3; ++channel)
            visit(one.front_color[channel], other.front_color[channel]);
        visit(one.front_share, other.front_share);
    }
}

// The segment's optical depth and colour, which is not associated, from its table entries.
template <bool lit>
LAMINA_INLINE SumOf<lit> integrate_colors(const TileTransfer& transfer, const Segment& segment,
                                          const SegmentEntries<lit>& entries) {
    const EntryOf<lit>& entry = entries.first;
    SumOf<lit> sum;
    sum.depth = entry.extinction * segment.first.length;
    const Float inverse = zero_unless(entry.extinction > 0, 1.0f / entry.extinction);
    for (int channel = 0; channel < 3; ++channel)
        sum.color[channel] = entry.emission[channel] * inverse;
    if constexpr (lit) {
        for (int channel = 0; channel < 3; ++channel)
            sum.front_color[channel] = entry.front_emission[channel] * inverse;
        sum.front_share = entry.front_extinction * inverse;
    }
    if (!segment.some_cut) return sum;
    const SumOf<lit> parts = sum_of_parts<lit>(transfer, segment, entries);
    sum.depth = select(segment.cut, parts.depth, sum.depth);
    const Float opacity = opacity_from_depth(parts.depth);
    const FloatMask some = parts.depth > 0;
    visit_colors<lit>(sum, parts, [&](Float& whole, Float of_parts) LAMINA_LAMBDA {
        const Float color = zero_unless(some, of_parts / opacity);
        whole = select(segment.cut, color, whole);
    });
    return sum;
}

// Optical depth alone, of tables without colour.
LAMINA_INLINE Float integrate_depth(const TileTransfer& transfer, const Segment& segment) {
    const Float whole =
        table_extinction(*transfer.table, segment.first.cell) * segment.first.length;
    if (!segment.some_cut) return whole;
    const bool some_parted = any_of(segment.parted);
    return select(segment.cut, depth_of_parts(transfer, segment, some_parted), whole);
}

// A segment's colour, which is not associated, and its optical depth. `entries` are used for tables
// with colour.
template <bool lit>
LAMINA_INLINE SumOf<lit> integrate_segment(const TileTransfer& transfer, bool colored,
                                           const Segment& segment,
                                           const SegmentEntries<lit>& entries) {
    SumOf<lit> sum;
    if (colored) {
        sum = integrate_colors<lit>(transfer, segment, entries);
    } else {
        sum.depth = integrate_depth(transfer, segment);
    }
    sum.depth = zero_unless(segment.seen, sum.depth);
    return sum;
}

template <Lookup kind>
LAMINA_INLINE RunSum integrate_run(const TileTransfer& transfer, bool colored, Float front,
                                   Float back, Float length, FloatMask seen) {
    const Segment segment = segment_of<kind>(transfer, front, back, length, seen);
    SegmentEntries<false> entries;
    const auto entry = [&](const TableRun& run, FloatMask wanted) LAMINA_LAMBDA {
        return table_entry<false>(transfer, run.cell, run.length, wanted);
    };
    if (colored) entries.first = entry(segment.first, seen);
    if (colored && segment.some_cut) entries.last = entry(segment.last, segment.cut);
    return integrate_segment<false>(transfer, colored, segment, entries);
}

LAMINA_SIMD_END

#endif
