// SPDX-License-Identifier: Apache-2.0
// Vector form of shaders/optics/preintegration.glsl, and of how slicing/segment.glsl uses it.
#if defined(LAMINA_SLICING_TILE_PREINTEGRATION_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_SLICING_TILE_PREINTEGRATION_INL_H_
#undef LAMINA_SLICING_TILE_PREINTEGRATION_INL_H_
#else
#define LAMINA_SLICING_TILE_PREINTEGRATION_INL_H_
#endif

#include <hwy/highway.h>

#include "slicing/tile_block-inl.h"
#include "slicing/tile_optics-inl.h"
#include "tiles/opacity-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {

using FloatMask = hn::Mask<FloatTag>;

// A cell of the table and where in it.
struct TableCell {
    Ints corner;  // front node + nodes * back node
    Floats front, back;
};

HWY_INLINE TableCell table_cell(std::int32_t nodes, Floats front, Floats back) {
    const FloatTag d;
    const IntTag di;
    const Ints last = hn::Set(di, nodes - 2);
    const Ints column = hn::Min(hn::ConvertTo(di, front), last);
    const Ints row = hn::Min(hn::ConvertTo(di, back), last);
    return {hn::Add(column, hn::Mul(row, hn::Set(di, nodes))),
            hn::Sub(front, hn::ConvertTo(d, column)), hn::Sub(back, hn::ConvertTo(d, row))};
}

// Bilinear in one plane of the table, whose entries are `stride` floats apart.
HWY_INLINE Floats bilinear(const float* plane, std::int32_t nodes, std::int32_t stride,
                           const TableCell& cell, Ints place) {
    const FloatTag d;
    const auto texel = [&](std::int32_t step) {
        return hn::GatherIndex(d, plane + static_cast<std::ptrdiff_t>(step) * stride, place);
    };
    const Floats front = mix(texel(0), texel(1), cell.front);
    const Floats back = mix(texel(nodes), texel(nodes + 1), cell.front);
    return mix(front, back, cell.back);
}

struct TableEntry {
    Floats emission[3];
    Floats extinction;  // mean
};

HWY_INLINE Floats table_extinction(const PreintegrationTable& table, const TableCell& cell) {
    const auto nodes = static_cast<std::int32_t>(table.nodes.size());
    return bilinear(table.mean_extinction.data(), nodes, 1, cell, cell.corner);
}

HWY_INLINE void set_emission(const TileTransfer& transfer, const TableCell& cell, Floats length,
                             TableEntry& entry) {
    const FloatTag d;
    const IntTag di;
    const auto nodes = static_cast<std::int32_t>(transfer.table->nodes.size());
    const auto layers = static_cast<std::int32_t>(transfer.table->lengths.size());
    const std::int32_t layer_floats = 4 * nodes * nodes;
    Ints place = hn::ShiftLeft<2>(cell.corner);
    if (layers == 1) {
        for (int channel = 0; channel < 3; ++channel) {
            entry.emission[channel] =
                bilinear(transfer.texels.data() + channel, nodes, 4, cell, place);
        }
        return;
    }
    const Floats layer = hn::Min(hn::Mul(length, hn::Set(d, transfer.layers_per_length)),
                                 hn::Set(d, static_cast<float>(layers - 1)));
    const Ints below = hn::Min(hn::ConvertTo(di, layer), hn::Set(di, layers - 2));
    const Floats share = hn::Sub(layer, hn::ConvertTo(d, below));
    place = hn::Add(place, hn::Mul(below, hn::Set(di, layer_floats)));
    for (int channel = 0; channel < 3; ++channel) {
        const float* const plane = transfer.texels.data() + channel;
        entry.emission[channel] = mix(bilinear(plane, nodes, 4, cell, place),
                                      bilinear(plane + layer_floats, nodes, 4, cell, place), share);
    }
}

// Coordinates of a scalar: its interval, its node.
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

// Colour, associated, and optical depth of the part of a segment behind which the next is put.
struct RunSum {
    Floats color[3];
    Floats depth;
};

// Adds a run between two nodes behind `sum`.
HWY_INLINE void add_run(const TileTransfer& transfer, bool colored, Floats front_node,
                        Floats back_node, Floats length, RunSum& sum) {
    const FloatTag d;
    const auto nodes = static_cast<std::int32_t>(transfer.table->nodes.size());
    const TableCell cell = table_cell(nodes, front_node, back_node);
    TableEntry entry;
    entry.extinction = table_extinction(*transfer.table, cell);
    const Floats depth = hn::Mul(entry.extinction, length);
    if (colored) {
        set_emission(transfer, cell, length, entry);
        const auto seen = hn::Gt(depth, hn::Zero(d));
        const Floats transmitted = exp_of(d, hn::Neg(sum.depth));
        const Floats weight = hn::IfThenElseZero(
            seen, hn::Div(hn::Mul(transmitted, opacity_from_depth(d, depth)), entry.extinction));
        for (int channel = 0; channel < 3; ++channel)
            sum.color[channel] = mul_add(weight, entry.emission[channel], sum.color[channel]);
    }
    sum.depth = hn::Add(sum.depth, depth);
}

struct RunEnds {
    Floats front, back, length;
    TablePlace front_place, back_place;
};

// Of a segment that crosses ends of intervals: cut at the first and at the last of these.
template <Lookup kind>
HWY_INLINE RunSum cut_run(const TileTransfer& transfer, bool colored, const RunEnds& run) {
    const FloatTag d;
    const IntTag di;
    const Ints one = hn::Set(di, 1);
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
    RunSum sum{{hn::Zero(d), hn::Zero(d), hn::Zero(d)}, hn::Zero(d)};
    add_run(transfer, colored, run.front_place.node, front_end,
            hn::Mul(hn::Sub(first_end, run.front), per_scalar), sum);
    add_run(transfer, colored, look_up<kind>(transfer.first_node, first), back_end,
            hn::Mul(hn::Sub(last_end, first_end), per_scalar), sum);
    add_run(transfer, colored, back_end, run.back_place.node,
            hn::Mul(hn::Sub(run.back, last_end), per_scalar), sum);
    return sum;
}

// A segment's colour, not associated, and its optical depth, where it shows anything at all.
template <Lookup kind>
HWY_INLINE RunSum integrate_run(const TileTransfer& transfer, bool colored, Floats front,
                                Floats back, Floats length, FloatMask seen) {
    const FloatTag d;
    const IntTag di;
    const RunEnds run{front, back, length, table_place<kind>(transfer, front),
                      table_place<kind>(transfer, back)};
    const auto nodes = static_cast<std::int32_t>(transfer.table->nodes.size());
    const TableCell cell = table_cell(nodes, run.front_place.node, run.back_place.node);
    TableEntry entry;
    entry.extinction = table_extinction(*transfer.table, cell);
    RunSum sum;
    sum.depth = hn::Mul(entry.extinction, length);
    if (colored) {
        set_emission(transfer, cell, length, entry);
        const auto some = hn::Gt(entry.extinction, hn::Zero(d));
        for (int channel = 0; channel < 3; ++channel) {
            sum.color[channel] =
                hn::IfThenElseZero(some, hn::Div(entry.emission[channel], entry.extinction));
        }
    }
    const auto cut =
        hn::And(hn::RebindMask(d, hn::Ne(run.front_place.interval, run.back_place.interval)), seen);
    if (kind != Lookup::one && !hn::AllFalse(d, cut)) {
        // Lanes that are not cut must not read beyond the intervals.
        RunEnds ends = run;
        const auto keep = hn::RebindMask(di, cut);
        ends.front_place.interval = hn::IfThenElseZero(keep, run.front_place.interval);
        ends.back_place.interval = hn::IfThenElseZero(keep, run.back_place.interval);
        ends.length = hn::IfThenElseZero(cut, length);
        ends.back = hn::IfThenElse(cut, back, hn::Add(front, hn::Set(d, 1.0f)));
        const RunSum parts = cut_run<kind>(transfer, colored, ends);
        sum.depth = hn::IfThenElse(cut, parts.depth, sum.depth);
        if (colored) {
            const Floats opacity = opacity_from_depth(d, parts.depth);
            const auto some = hn::Gt(parts.depth, hn::Zero(d));
            for (int channel = 0; channel < 3; ++channel) {
                const Floats color =
                    hn::IfThenElseZero(some, hn::Div(parts.color[channel], opacity));
                sum.color[channel] = hn::IfThenElse(cut, color, sum.color[channel]);
            }
        }
    }
    sum.depth = hn::IfThenElseZero(seen, sum.depth);
    return sum;
}

// The whole block: what shows nothing between the least and the largest of its three samples shows
// nothing; the others run straight, moved so that their mean is that of the parabola through them.
template <Lookup kind>
HWY_INLINE void integrate_runs(const TileTransfer& transfer, bool colored, bool nan_transparent,
                               SlabBlock& block) {
    const FloatTag d;
    const auto nodes = static_cast<std::int32_t>(transfer.table->nodes.size());
    for (int i = block.from; i < block.end; ++i) {
        Floats front = hn::Load(d, block.edge_scalars + at(i));
        Floats middle = hn::Load(d, block.scalars + at(i));
        Floats back = hn::Load(d, block.edge_scalars + at(i + 1));
        const Floats length = hn::Load(d, block.lengths + at(i));
        auto seen = hn::Gt(length, hn::Zero(d));
        if (nan_transparent) {
            const Floats sum = hn::Add(hn::Add(front, middle), back);
            const auto numbers = hn::Eq(sum, sum);
            seen = hn::And(seen, numbers);
            front = hn::IfThenElseZero(numbers, front);
            middle = hn::IfThenElseZero(numbers, middle);
            back = hn::IfThenElseZero(numbers, back);
        }
        const Floats least = clamp01(d, hn::Min(middle, hn::Min(front, back)));
        const Floats largest = clamp01(d, hn::Max(middle, hn::Max(front, back)));
        const TableCell extremes = table_cell(nodes, table_place<kind>(transfer, least).node,
                                              table_place<kind>(transfer, largest).node);
        const Floats visible = table_extinction(*transfer.table, extremes);
        seen = hn::And(seen, hn::Ne(visible, hn::Zero(d)));
        if (hn::AllFalse(d, seen)) {
            hn::Store(hn::Zero(d), d, block.depths + at(i));
            if (!colored) continue;
            for (auto& color : block.colors) hn::Store(hn::Zero(d), d, color + at(i));
            continue;
        }
        const Floats mean = hn::Mul(hn::Set(d, 0.5f), hn::Add(front, back));
        const Floats bend = hn::Mul(hn::Set(d, 2.0f / 3.0f), hn::Sub(middle, mean));
        const RunSum run = integrate_run<kind>(transfer, colored, clamp01(d, hn::Add(front, bend)),
                                               clamp01(d, hn::Add(back, bend)), length, seen);
        hn::Store(run.depth, d, block.depths + at(i));
        if (!colored) continue;
        for (std::size_t channel = 0; channel < 3; ++channel)
            hn::Store(run.color[channel], d, block.colors[channel] + at(i));
    }
}

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
