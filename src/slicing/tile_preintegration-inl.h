// SPDX-License-Identifier: Apache-2.0
// Vector form of shaders/optics/preintegration.glsl, and of how slicing/segment.glsl uses it.
#if defined(LAMINA_SLICING_TILE_PREINTEGRATION_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_SLICING_TILE_PREINTEGRATION_INL_H_
#undef LAMINA_SLICING_TILE_PREINTEGRATION_INL_H_
#else
#define LAMINA_SLICING_TILE_PREINTEGRATION_INL_H_
#endif

#include <hwy/highway.h>

#include <bit>

#include "slicing/tile_block-inl.h"
#include "slicing/tile_optics-inl.h"
#include "tiles/linear_segment-inl.h"
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

// An entry of the table: emission, of coloured tables, and mean extinction.
struct TableEntry {
    Floats emission[3];
    Floats extinction;
};

// Bilinear between the four nodes of a cell.
HWY_INLINE Floats table_extinction(const PreintegrationTable& table, const TableCell& cell) {
    const FloatTag d;
    const auto nodes = static_cast<std::int32_t>(table.nodes.size());
    const float* const entries = table.mean_extinction.data();
    const auto texel = [&](std::int32_t step)
                           HWY_ATTR { return hn::GatherIndex(d, entries + step, cell.corner); };
    const Floats front = mix(texel(0), texel(1), cell.front);
    const Floats back = mix(texel(nodes), texel(nodes + 1), cell.front);
    return mix(front, back, cell.back);
}

template <class D>
HWY_INLINE hn::Vec<D> mixed_nodes(D d, const float* texels, std::ptrdiff_t right,
                                  std::ptrdiff_t below, float front, float back) {
    const auto share = hn::Set(d, front);
    const auto near = mix(hn::LoadU(d, texels), hn::LoadU(d, texels + right), share);
    const auto far = mix(hn::LoadU(d, texels + below), hn::LoadU(d, texels + below + right), share);
    return mix(near, far, hn::Set(d, back));
}

// Between two layers of length, which lie side by side: both at once where vectors are long enough.
template <class D8>
HWY_INLINE void mix_layers(D8 d8, const float* texels, std::ptrdiff_t right, std::ptrdiff_t below,
                           float front, float back, float layer, float* entry) {
    const hn::FixedTag<float, 4> d4;
    const auto share = hn::Set(d4, layer);
    if constexpr (hn::MaxLanes(d8) == 8) {
        const auto both = mixed_nodes(d8, texels, right, below, front, back);
        hn::Store(mix(hn::LowerHalf(d4, both), hn::UpperHalf(d4, both), share), d4, entry);
    } else {
        const auto one = mixed_nodes(d4, texels, right, below, front, back);
        const auto next = mixed_nodes(d4, texels + 4, right, below, front, back);
        hn::Store(mix(one, next, share), d4, entry);
    }
}

// Calls body(lane) for the lanes of a mask.
template <class Body>
HWY_INLINE void for_each_lane(FloatMask mask, const Body& body) {
    alignas(8) std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(FloatTag(), mask, bytes);
    for (std::uint32_t bits = bytes[0] | std::uint32_t{bytes[1]} << 8; bits != 0; bits &= bits - 1)
        body(static_cast<std::size_t>(std::countr_zero(bits)));
}

// Lane by lane, because an entry's numbers lie side by side: several times as fast as gathers of
// one number each. Of the lanes that are `wanted`; 0 in others.
HWY_INLINE TableEntry table_entry(const TileTransfer& transfer, const TableCell& cell,
                                  Floats length, FloatMask wanted) {
    const FloatTag d;
    const IntTag di;
    const auto nodes = static_cast<std::ptrdiff_t>(transfer.table->nodes.size());
    const auto layers = static_cast<std::int32_t>(transfer.table->lengths.size());
    const Floats layer = hn::Min(hn::Mul(length, hn::Set(d, transfer.layers_per_length)),
                                 hn::Set(d, static_cast<float>(layers - 1)));
    const Ints lower = hn::Min(hn::ConvertTo(di, layer), hn::Set(di, std::max(layers - 2, 0)));
    alignas(64) std::int32_t places[most_lanes];
    alignas(64) float fronts[most_lanes], backs[most_lanes], layer_shares[most_lanes];
    alignas(64) float entries[4 * most_lanes] = {};
    hn::Store(hn::Add(hn::Mul(cell.corner, hn::Set(di, layers)), lower), di, places);
    hn::Store(cell.front, d, fronts);
    hn::Store(cell.back, d, backs);
    hn::Store(hn::Sub(layer, hn::ConvertTo(d, lower)), d, layer_shares);
    const std::ptrdiff_t right = 4 * layers, below = right * nodes;
    for_each_lane(wanted, [&](std::size_t lane) HWY_ATTR {
        const float* const texels =
            transfer.texels.data() + 4 * static_cast<std::ptrdiff_t>(places[lane]);
        if (layers > 1) {
            mix_layers(hn::CappedTag<float, 8>(), texels, right, below, fronts[lane], backs[lane],
                       layer_shares[lane], entries + 4 * lane);
        } else {
            const hn::FixedTag<float, 4> d4;
            hn::Store(mixed_nodes(d4, texels, right, below, fronts[lane], backs[lane]), d4,
                      entries + 4 * lane);
        }
    });
    TableEntry entry;
    hn::LoadInterleaved4(d, entries, entry.emission[0], entry.emission[1], entry.emission[2],
                         entry.extinction);
    return entry;
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

// Adds a run between two nodes behind `sum`, in the lanes that are `wanted`; others lose their
// meaning.
HWY_INLINE void add_run(const TileTransfer& transfer, bool colored, Floats front_node,
                        Floats back_node, Floats length, FloatMask wanted, RunSum& sum) {
    const FloatTag d;
    const auto nodes = static_cast<std::int32_t>(transfer.table->nodes.size());
    const TableCell cell = table_cell(nodes, front_node, back_node);
    if (!colored) {
        sum.depth = mul_add(table_extinction(*transfer.table, cell), length, sum.depth);
        return;
    }
    const TableEntry entry = table_entry(transfer, cell, length, wanted);
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

// Of segments that cross ends of intervals, those of the lanes that are `wanted`: cut at the first
// and at the last of these.
template <Lookup kind>
HWY_INLINE RunSum cut_run(const TileTransfer& transfer, bool colored, const RunEnds& run,
                          FloatMask wanted) {
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
            hn::Mul(hn::Sub(first_end, run.front), per_scalar), wanted, sum);
    // Most segments cross one end: nothing lies between the first and the last.
    const auto between = hn::And(wanted, hn::Ne(first_end, last_end));
    if (!hn::AllFalse(d, between)) {
        add_run(transfer, colored, look_up<kind>(transfer.first_node, first), back_end,
                hn::Mul(hn::Sub(last_end, first_end), per_scalar), between, sum);
    }
    add_run(transfer, colored, back_end, run.back_place.node,
            hn::Mul(hn::Sub(run.back, last_end), per_scalar), wanted, sum);
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
    const auto cut =
        hn::And(hn::RebindMask(d, hn::Ne(run.front_place.interval, run.back_place.interval)), seen);
    RunSum sum;
    if (colored) {
        const TableEntry entry = table_entry(transfer, cell, length, hn::AndNot(cut, seen));
        sum.depth = hn::Mul(entry.extinction, length);
        const Floats inverse = hn::IfThenElseZero(hn::Gt(entry.extinction, hn::Zero(d)),
                                                  hn::Div(hn::Set(d, 1.0f), entry.extinction));
        for (int channel = 0; channel < 3; ++channel)
            sum.color[channel] = hn::Mul(entry.emission[channel], inverse);
    } else {
        sum.depth = hn::Mul(table_extinction(*transfer.table, cell), length);
    }
    if (kind != Lookup::one && !hn::AllFalse(d, cut)) {
        // Lanes that are not cut must not read beyond the intervals.
        RunEnds ends = run;
        const auto keep = hn::RebindMask(di, cut);
        ends.front_place.interval = hn::IfThenElseZero(keep, run.front_place.interval);
        ends.back_place.interval = hn::IfThenElseZero(keep, run.back_place.interval);
        ends.length = hn::IfThenElseZero(cut, length);
        ends.back = hn::IfThenElse(cut, back, hn::Add(front, hn::Set(d, 1.0f)));
        const RunSum parts = cut_run<kind>(transfer, colored, ends, cut);
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

// Whether there is extinction anywhere between two scalars: in an interval before the last, or in
// that one, unless it only begins there, with none.
template <Lookup kind>
HWY_INLINE FloatMask shows_something(const TileTransfer& transfer, Floats least, Floats largest) {
    const FloatTag d;
    const Ints first = find_interval<kind>(transfer, least);
    const Ints last = find_interval<kind>(transfer, largest);
    const auto before = hn::Gt(look_up<kind>(transfer.shown_before, last),
                               look_up<kind>(transfer.shown_before, first));
    const Floats share = share_of_interval<kind>(transfer, last, largest);
    const Floats left = look_up<kind>(transfer.left[3], last);
    const auto begun = hn::Gt(hn::Add(share, left), hn::Zero(d));
    const auto shown = hn::Gt(look_up<kind>(transfer.shown, last), hn::Zero(d));
    return hn::Or(before, hn::And(shown, begun));
}

// The scalars of a segment, normalised; 0 with length 0 where one is no number.
struct RunScalars {
    Floats front, middle, back, length;
};

HWY_INLINE RunScalars run_scalars(const SlabBlock& block, int i, bool nan_transparent) {
    const FloatTag d;
    RunScalars run{hn::Load(d, block.edge_scalars + at(i)), hn::Load(d, block.scalars + at(i)),
                   hn::Load(d, block.edge_scalars + at(i + 1)), hn::Load(d, block.lengths + at(i))};
    if (!nan_transparent) return run;
    const Floats sum = hn::Add(hn::Add(run.front, run.middle), run.back);
    const auto numbers = hn::Eq(sum, sum);
    for (Floats* const v : {&run.front, &run.middle, &run.back, &run.length})
        *v = hn::IfThenElseZero(numbers, *v);
    return run;
}

// Makes it straight: moved so that its mean is that of the parabola through the three scalars.
HWY_INLINE void straighten(RunScalars& run) {
    const FloatTag d;
    const Floats mean = hn::Mul(hn::Set(d, 0.5f), hn::Add(run.front, run.back));
    const Floats bend = hn::Mul(hn::Set(d, 2.0f / 3.0f), hn::Sub(run.middle, mean));
    run.front = clamp01(d, hn::Add(run.front, bend));
    run.back = clamp01(d, hn::Add(run.back, bend));
}

// Where the transfer function is one piece: in closed form, as shaders/slicing/segment.glsl.
HWY_INLINE RunSum integrate_linear(const TileTransfer& transfer, bool colored,
                                   const RunScalars& run) {
    constexpr Lookup one = Lookup::one;
    const FloatTag d;
    const Floats half = hn::Set(d, 0.5f);
    const Ints piece = hn::Zero(IntTag());
    const Floats front = share_of_interval<one>(transfer, piece, run.front),
                 back = share_of_interval<one>(transfer, piece, run.back);
    const Floats p = hn::Mul(optics_at<one>(transfer, 3, piece, front), run.length),
                 q = hn::Mul(optics_at<one>(transfer, 3, piece, back), run.length);
    RunSum sum;
    sum.depth = hn::Add(hn::Mul(half, p), hn::Mul(half, q));
    if (!colored) return sum;
    const Floats opacity = opacity_from_depth(d, sum.depth);
    const Floats weight = hn::Min(thin_front_weight(d, p, q), opacity);
    const Floats of_front = hn::Div(weight, hn::Max(opacity, hn::Set(d, 1e-37f)));
    const Floats place = mix(back, front, of_front);
    for (std::size_t channel = 0; channel < 3; ++channel)
        sum.color[channel] = optics_at<one>(transfer, channel, piece, place);
    return sum;
}

// By the table: what shows nothing between the least and the largest of its three samples shows
// nothing.
template <Lookup kind>
HWY_INLINE RunSum integrate_by_table(const TileTransfer& transfer, bool colored, RunScalars run) {
    const FloatTag d;
    const Floats least = clamp01(d, hn::Min(run.middle, hn::Min(run.front, run.back)));
    const Floats largest = clamp01(d, hn::Max(run.middle, hn::Max(run.front, run.back)));
    const auto seen =
        hn::And(hn::Gt(run.length, hn::Zero(d)), shows_something<kind>(transfer, least, largest));
    if (hn::AllFalse(d, seen)) return {{hn::Zero(d), hn::Zero(d), hn::Zero(d)}, hn::Zero(d)};
    straighten(run);
    return integrate_run<kind>(transfer, colored, run.front, run.back, run.length, seen);
}

// The whole block.
template <Lookup kind>
HWY_INLINE void integrate_runs(const TileTransfer& transfer, bool colored, const SlicePlan& plan,
                               SlabBlock& block) {
    const FloatTag d;
    const auto integrate_all = [&](const auto& integrate) HWY_ATTR {
        for (int i = block.from; i < block.end; ++i) {
            const RunSum run = integrate(run_scalars(block, i, plan.nan_transparent));
            hn::Store(run.depth, d, block.depths + at(i));
            if (!colored) continue;
            for (std::size_t channel = 0; channel < 3; ++channel)
                hn::Store(run.color[channel], d, block.colors[channel] + at(i));
        }
    };
    if (kind == Lookup::one && plan.linear) {
        integrate_all([&](RunScalars run) HWY_ATTR {
            straighten(run);
            return integrate_linear(transfer, colored, run);
        });
    } else {
        integrate_all([&](const RunScalars& run)
                          HWY_ATTR { return integrate_by_table<kind>(transfer, colored, run); });
    }
}

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
