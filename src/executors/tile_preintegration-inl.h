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
// With front parts of colour and opacity (optics/front_parts.h), as colour is: associated, or not.
struct LitSum : RunSum {
    Floats front_color[3];
    Floats front_share;
};
template <bool lit>
using SumOf = std::conditional_t<lit, LitSum, RunSum>;

template <bool lit>
HWY_INLINE SumOf<lit> no_sum() {
    const Floats zero = hn::Zero(FloatTag());
    if constexpr (lit)
        return {{{zero, zero, zero}, zero}, {zero, zero, zero}, zero};
    else
        return {{zero, zero, zero}, zero};
}

// Adds a run with the given table entry behind `sum`. Of lit segments `share` is the run's share
// of the segment's length and `left` that of what is behind it.
struct RunShares {
    Floats share, left;
};
template <bool lit>
HWY_INLINE void add_entry(const EntryOf<lit>& entry, Floats length, const RunShares& shares,
                          SumOf<lit>& sum) {
    const FloatTag d;
    const Floats depth = hn::Mul(entry.extinction, length);
    const auto seen = hn::Gt(depth, hn::Zero(d));
    const Floats transmitted = exp_of(d, hn::Neg(sum.depth));
    const Floats weight = hn::IfThenElseZero(
        seen, hn::Div(hn::Mul(transmitted, opacity_from_depth(d, depth)), entry.extinction));
    for (int channel = 0; channel < 3; ++channel)
        sum.color[channel] = mul_add(weight, entry.emission[channel], sum.color[channel]);
    if constexpr (lit) {
        const auto add = [&](Floats whole, Floats front, Floats& to) HWY_ATTR {
            const Floats seen_part = mul_add(shares.left, whole, hn::Mul(shares.share, front));
            to = mul_add(weight, seen_part, to);
        };
        for (int channel = 0; channel < 3; ++channel)
            add(entry.emission[channel], entry.front_emission[channel], sum.front_color[channel]);
        add(entry.extinction, entry.front_extinction, sum.front_share);
    }
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
    Floats length;
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
    segment.length = segment.first.length = length;
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
template <bool lit>
struct SegmentEntries {
    EntryOf<lit> first, last;
};

// Optical depth of the lanes that are cut. The values of other lanes have no meaning.
HWY_INLINE Floats depth_of_parts(const TileTransfer& transfer, const Segment& segment,
                                 bool some_parted) {
    Floats depth = hn::Zero(FloatTag());
    const auto add = [&](const TableRun& run) HWY_ATTR {
        depth = mul_add(table_extinction(*transfer.table, run.cell), run.length, depth);
    };
    add(segment.first);
    if (some_parted) add(segment.between);
    add(segment.last);
    return depth;
}

// Associated colour and optical depth of the lanes that are cut. The values of other lanes have no
// meaning.
template <bool lit>
HWY_INLINE SumOf<lit> sum_of_parts(const TileTransfer& transfer, const Segment& segment,
                                   const SegmentEntries<lit>& entries) {
    const FloatTag d;
    SumOf<lit> sum = no_sum<lit>();
    RunShares first, between, last;
    if constexpr (lit) {
        const Floats inverse = hn::Div(hn::Set(d, 1.0f), segment.length);
        first.share = hn::Mul(segment.first.length, inverse);
        last.share = hn::Mul(segment.last.length, inverse);
        last.left = hn::Zero(d);
        between.share = hn::Mul(segment.between.length, inverse);
        between.left = last.share;
        first.left = hn::Add(between.share, last.share);
    }
    add_entry<lit>(entries.first, segment.first.length, first, sum);
    if (!hn::AllFalse(d, segment.parted)) {
        const TableRun& run = segment.between;
        add_entry<lit>(table_entry<lit>(transfer, run.cell, run.length, segment.parted), run.length,
                       between, sum);
    }
    add_entry<lit>(entries.last, segment.last.length, last, sum);
    return sum;
}

// Calls visit(number of one, the same of the other) for what a sum has of colours.
template <bool lit, class Visit>
HWY_INLINE void visit_colors(SumOf<lit>& one, const SumOf<lit>& other, const Visit& visit) {
    for (int channel = 0; channel < 3; ++channel) visit(one.color[channel], other.color[channel]);
    if constexpr (lit) {
        for (int channel = 0; channel < 3; ++channel)
            visit(one.front_color[channel], other.front_color[channel]);
        visit(one.front_share, other.front_share);
    }
}

// The segment's optical depth and colour, which is not associated, from its table entries.
template <bool lit>
HWY_INLINE SumOf<lit> integrate_colors(const TileTransfer& transfer, const Segment& segment,
                                       const SegmentEntries<lit>& entries) {
    const FloatTag d;
    const EntryOf<lit>& entry = entries.first;
    SumOf<lit> sum;
    sum.depth = hn::Mul(entry.extinction, segment.first.length);
    const Floats inverse = hn::IfThenElseZero(hn::Gt(entry.extinction, hn::Zero(d)),
                                              hn::Div(hn::Set(d, 1.0f), entry.extinction));
    for (int channel = 0; channel < 3; ++channel)
        sum.color[channel] = hn::Mul(entry.emission[channel], inverse);
    if constexpr (lit) {
        for (int channel = 0; channel < 3; ++channel)
            sum.front_color[channel] = hn::Mul(entry.front_emission[channel], inverse);
        sum.front_share = hn::Mul(entry.front_extinction, inverse);
    }
    if (!segment.some_cut) return sum;
    const SumOf<lit> parts = sum_of_parts<lit>(transfer, segment, entries);
    sum.depth = hn::IfThenElse(segment.cut, parts.depth, sum.depth);
    const Floats opacity = opacity_from_depth(d, parts.depth);
    const auto some = hn::Gt(parts.depth, hn::Zero(d));
    visit_colors<lit>(sum, parts, [&](Floats& whole, Floats of_parts) HWY_ATTR {
        const Floats color = hn::IfThenElseZero(some, hn::Div(of_parts, opacity));
        whole = hn::IfThenElse(segment.cut, color, whole);
    });
    return sum;
}

// Optical depth alone, of tables without colour.
HWY_INLINE Floats integrate_depth(const TileTransfer& transfer, const Segment& segment) {
    const FloatTag d;
    const Floats whole =
        hn::Mul(table_extinction(*transfer.table, segment.first.cell), segment.first.length);
    if (!segment.some_cut) return whole;
    const bool some_parted = !hn::AllFalse(d, segment.parted);
    return hn::IfThenElse(segment.cut, depth_of_parts(transfer, segment, some_parted), whole);
}

// A segment's colour, which is not associated, and its optical depth. `entries` are used for tables
// with colour.
template <bool lit>
HWY_INLINE SumOf<lit> integrate_segment(const TileTransfer& transfer, bool colored,
                                        const Segment& segment,
                                        const SegmentEntries<lit>& entries) {
    SumOf<lit> sum;
    if (colored) {
        sum = integrate_colors<lit>(transfer, segment, entries);
    } else {
        sum.depth = integrate_depth(transfer, segment);
    }
    sum.depth = hn::IfThenElseZero(segment.seen, sum.depth);
    return sum;
}

template <Lookup kind>
HWY_INLINE RunSum integrate_run(const TileTransfer& transfer, bool colored, Floats front,
                                Floats back, Floats length, FloatMask seen) {
    const Segment segment = segment_of<kind>(transfer, front, back, length, seen);
    SegmentEntries<false> entries;
    const auto entry = [&](const TableRun& run, FloatMask wanted) HWY_ATTR {
        return table_entry<false>(transfer, run.cell, run.length, wanted);
    };
    if (colored) entries.first = entry(segment.first, seen);
    if (colored && segment.some_cut) entries.last = entry(segment.last, segment.cut);
    return integrate_segment<false>(transfer, colored, segment, entries);
}

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
