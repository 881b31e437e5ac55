// SPDX-License-Identifier: Apache-2.0
// Vector form of how shaders/slicing/segment.glsl reads the pre-integration table.
#if defined(LAMINA_EXECUTORS_TILE_PREINTEGRATION_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_EXECUTORS_TILE_PREINTEGRATION_INL_H_
#undef LAMINA_EXECUTORS_TILE_PREINTEGRATION_INL_H_
#else
#define LAMINA_EXECUTORS_TILE_PREINTEGRATION_INL_H_
#endif

#include <hwy/highway.h>

#include "executors/tile_table-inl.h"
#include "tiles/linear_segment-inl.h"
#include "tiles/opacity-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {

// A scalar's interval and its node coordinate in the table.
struct TablePlace {
    Ints interval;
    Floats node;
};

template <Lookup kind>
HWY_INLINE TablePlace table_place(const TileTransfer& transfer, Floats scalar) {
    const Ints interval = find_interval<kind>(transfer, scalar);
    const Floats share = share_of_interval<kind>(transfer, interval, scalar);
    return {interval, mul_add(share, look_up<kind>(transfer.nodes, interval),
                              look_up<kind>(transfer.first_node, interval))};
}

// Associated colour and optical depth of the front of a segment, behind which the next run is
// added.
struct RunSum {
    Floats color[3];
    Floats depth;
};

// Adds a run with the given table entry behind `sum`.
HWY_INLINE void add_entry(const TableEntry& entry, Floats length, RunSum& sum) {
    const FloatTag d;
    const Floats depth = hn::Mul(entry.extinction, length);
    const auto seen = hn::Gt(depth, hn::Zero(d));
    const Floats transmitted = exp_of(d, hn::Neg(sum.depth));
    const Floats weight = hn::IfThenElseZero(
        seen, hn::Div(hn::Mul(transmitted, opacity_from_depth(d, depth)), entry.extinction));
    for (int channel = 0; channel < 3; ++channel)
        sum.color[channel] = mul_add(weight, entry.emission[channel], sum.color[channel]);
    sum.depth = hn::Add(sum.depth, depth);
}

struct RunEnds {
    Floats front, back, length;
    TablePlace front_place, back_place;
};

// The stretch of a segment that one look-up integrates.
struct TableRun {
    TableCell cell;
    Floats length;
};

// A segment before the table is looked up. Where the segment crosses ends of intervals, it is cut
// at the first and at the last of these. `first` is the stretch before the first cut, or all of the
// segment. Most segments that are cut cross one end only and have nothing `between`.
struct Segment {
    TableRun first, between, last;
    FloatMask seen, cut, parted;  // shows something; is cut; has something between
    bool some_cut;
};

HWY_INLINE std::int32_t table_nodes(const TileTransfer& transfer) {
    return static_cast<std::int32_t>(transfer.table->nodes.size());
}

// Sets first, between and last in the lanes that are cut.
template <Lookup kind>
HWY_INLINE void cut_segment(const TileTransfer& transfer, const RunEnds& run, Segment& segment) {
    const IntTag di;
    const Ints one = hn::Set(di, 1);
    const std::int32_t nodes = table_nodes(transfer);
    const auto rising = hn::Lt(run.front, run.back);
    const auto rising_int = hn::RebindMask(di, rising);
    const Ints front_interval = run.front_place.interval, back_interval = run.back_place.interval;
    const Ints first = hn::IfThenElse(rising_int, hn::Add(front_interval, one), front_interval);
    const Ints last = hn::IfThenElse(rising_int, back_interval, hn::Add(back_interval, one));
    const Floats first_end = look_up<kind>(transfer.end, first);
    const Floats last_end = look_up<kind>(transfer.end, last);
    const auto right_node = [&](Ints interval) {
        return hn::Add(look_up<kind>(transfer.first_node, interval),
                       look_up<kind>(transfer.nodes, interval));
    };
    const Floats back_end = hn::IfThenElse(
        rising, look_up<kind>(transfer.first_node, back_interval), right_node(back_interval));
    const Floats front_end = hn::IfThenElse(rising, right_node(front_interval),
                                            look_up<kind>(transfer.first_node, front_interval));
    const Floats per_scalar = hn::Div(run.length, hn::Sub(run.back, run.front));
    const auto length = [&](Floats from, Floats to)
                            HWY_ATTR { return hn::Mul(hn::Sub(to, from), per_scalar); };
    const FloatMask cut = segment.cut;
    segment.parted = hn::And(cut, hn::Ne(first_end, last_end));
    segment.first = {table_cell(nodes, run.front_place.node,
                                hn::IfThenElse(cut, front_end, run.back_place.node)),
                     hn::IfThenElse(cut, length(run.front, first_end), segment.first.length)};
    segment.between = {table_cell(nodes, look_up<kind>(transfer.first_node, first), back_end),
                       length(first_end, last_end)};
    segment.last = {table_cell(nodes, back_end, run.back_place.node), length(last_end, run.back)};
}

// Replaces the intervals of lanes that are not cut, so that these do not read beyond the last
// interval.
HWY_INLINE RunEnds ends_of_cut(const RunEnds& run, FloatMask cut) {
    const FloatTag d;
    const auto keep = hn::RebindMask(IntTag(), cut);
    RunEnds ends = run;
    ends.front_place.interval = hn::IfThenElseZero(keep, ends.front_place.interval);
    ends.back_place.interval = hn::IfThenElseZero(keep, ends.back_place.interval);
    ends.length = hn::IfThenElseZero(cut, ends.length);
    ends.back = hn::IfThenElse(cut, ends.back, hn::Add(ends.front, hn::Set(d, 1.0f)));
    return ends;
}

template <Lookup kind>
HWY_INLINE Segment segment_of(const TileTransfer& transfer, Floats front, Floats back,
                              Floats length, FloatMask seen) {
    const FloatTag d;
    const RunEnds ends{front, back, length, table_place<kind>(transfer, front),
                       table_place<kind>(transfer, back)};
    Segment segment;
    segment.first.length = length;
    segment.seen = seen;
    segment.cut = hn::And(
        hn::RebindMask(d, hn::Ne(ends.front_place.interval, ends.back_place.interval)), seen);
    segment.some_cut = kind != Lookup::one && !hn::AllFalse(d, segment.cut);
    if (segment.some_cut) {
        cut_segment<kind>(transfer, ends_of_cut(ends, segment.cut), segment);
    } else {
        segment.first.cell =
            table_cell(table_nodes(transfer), ends.front_place.node, ends.back_place.node);
    }
    return segment;
}

// The table entries of `first` and `last` of a segment.
struct SegmentEntries {
    TableEntry first, last;
};

// Colour and optical depth of the lanes that are cut. The values of other lanes have no meaning.
HWY_INLINE RunSum sum_of_parts(const TileTransfer& transfer, bool colored, const Segment& segment,
                               const SegmentEntries& entries) {
    const FloatTag d;
    RunSum sum{{hn::Zero(d), hn::Zero(d), hn::Zero(d)}, hn::Zero(d)};
    const bool some_parted = !hn::AllFalse(d, segment.parted);
    if (!colored) {
        const auto add = [&](const TableRun& run) HWY_ATTR {
            sum.depth = mul_add(table_extinction(*transfer.table, run.cell), run.length, sum.depth);
        };
        add(segment.first);
        if (some_parted) add(segment.between);
        add(segment.last);
        return sum;
    }
    add_entry(entries.first, segment.first.length, sum);
    if (some_parted) {
        const TableRun& run = segment.between;
        add_entry(table_entry(transfer, run.cell, run.length, segment.parted), run.length, sum);
    }
    add_entry(entries.last, segment.last.length, sum);
    return sum;
}

// A segment's colour, which is not associated, and its optical depth. `entries` are used for tables
// with colour.
HWY_INLINE RunSum integrate_segment(const TileTransfer& transfer, bool colored,
                                    const Segment& segment, const SegmentEntries& entries) {
    const FloatTag d;
    RunSum sum;
    if (colored) {
        const TableEntry& entry = entries.first;
        sum.depth = hn::Mul(entry.extinction, segment.first.length);
        const Floats inverse = hn::IfThenElseZero(hn::Gt(entry.extinction, hn::Zero(d)),
                                                  hn::Div(hn::Set(d, 1.0f), entry.extinction));
        for (int channel = 0; channel < 3; ++channel)
            sum.color[channel] = hn::Mul(entry.emission[channel], inverse);
    } else {
        sum.depth =
            hn::Mul(table_extinction(*transfer.table, segment.first.cell), segment.first.length);
    }
    if (segment.some_cut) {
        const RunSum parts = sum_of_parts(transfer, colored, segment, entries);
        sum.depth = hn::IfThenElse(segment.cut, parts.depth, sum.depth);
        if (colored) {
            const Floats opacity = opacity_from_depth(d, parts.depth);
            const auto some = hn::Gt(parts.depth, hn::Zero(d));
            for (int channel = 0; channel < 3; ++channel) {
                const Floats color =
                    hn::IfThenElseZero(some, hn::Div(parts.color[channel], opacity));
                sum.color[channel] = hn::IfThenElse(segment.cut, color, sum.color[channel]);
            }
        }
    }
    sum.depth = hn::IfThenElseZero(segment.seen, sum.depth);
    return sum;
}

template <Lookup kind>
HWY_INLINE RunSum integrate_run(const TileTransfer& transfer, bool colored, Floats front,
                                Floats back, Floats length, FloatMask seen) {
    const Segment segment = segment_of<kind>(transfer, front, back, length, seen);
    SegmentEntries entries;
    const auto entry = [&](const TableRun& run, FloatMask wanted)
                           HWY_ATTR { return table_entry(transfer, run.cell, run.length, wanted); };
    if (colored) entries.first = entry(segment.first, seen);
    if (colored && segment.some_cut) entries.last = entry(segment.last, segment.cut);
    return integrate_segment(transfer, colored, segment, entries);
}

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
