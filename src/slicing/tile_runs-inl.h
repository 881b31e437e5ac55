// SPDX-License-Identifier: Apache-2.0
// Pre-integration of a block's slabs: vector form of how shaders/slicing/segment.glsl uses the
// table.
#if defined(LAMINA_SLICING_TILE_RUNS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_SLICING_TILE_RUNS_INL_H_
#undef LAMINA_SLICING_TILE_RUNS_INL_H_
#else
#define LAMINA_SLICING_TILE_RUNS_INL_H_
#endif

#include <hwy/highway.h>

#include "executors/tile_preintegration-inl.h"
#include "slicing/tile_block-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {

// The normalised scalars of a segment. Where one of them is NaN, scalars and length are 0.
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

// Makes the scalar linear along the segment: both ends are moved so that its mean is the mean of
// the parabola through the three scalars.
HWY_INLINE void straighten(RunScalars& run) {
    const FloatTag d;
    const Floats mean = hn::Mul(hn::Set(d, 0.5f), hn::Add(run.front, run.back));
    const Floats bend = hn::Mul(hn::Set(d, 2.0f / 3.0f), hn::Sub(run.middle, mean));
    run.front = clamp01(d, hn::Add(run.front, bend));
    run.back = clamp01(d, hn::Add(run.back, bend));
}

// Integrates in closed form where the transfer function is one linear piece, as
// shaders/slicing/segment.glsl does.
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

HWY_INLINE void store_run(const RunSum& run, bool colored, int slab, SlabBlock& block) {
    const FloatTag d;
    hn::Store(run.depth, d, block.depths + at(slab));
    if (!colored) return;
    for (std::size_t channel = 0; channel < 3; ++channel)
        hn::Store(run.color[channel], d, block.colors[channel] + at(slab));
}
HWY_INLINE void store_run(const LitSum& run, bool colored, int slab, SlabBlock& block) {
    const FloatTag d;
    const RunSum& unlit = run;
    store_run(unlit, colored, slab, block);
    for (std::size_t channel = 0; channel < 3; ++channel)
        hn::Store(run.front_color[channel], d, block.front_colors[channel] + at(slab));
    hn::Store(run.front_share, d, block.front_shares + at(slab));
}

// Integrates by the table, in stages of a few slabs, so that many entries are looked up at a time.
// A segment shows nothing where the transfer function shows nothing between the least and the
// largest of its three scalars.
template <Lookup kind, bool lit>
HWY_INLINE void integrate_by_table(const TileTransfer& transfer, bool colored, bool nan_transparent,
                                   SlabBlock& block) {
    const FloatTag d;
    constexpr int stage = 8;
    const Floats zero = hn::Zero(d);
    Segment segments[stage];
    EntryPlaces first_places[stage], last_places[stage];
    EntryNumbers<lit> first_entries[stage], last_entries[stage];
    int slabs[stage];
    for (int begin = block.from; begin < block.end;) {
        int count = 0;
        for (; count < stage && begin < block.end; ++begin) {
            RunScalars run = run_scalars(block, begin, nan_transparent);
            const Floats least = clamp01(d, hn::Min(run.middle, hn::Min(run.front, run.back)));
            const Floats largest = clamp01(d, hn::Max(run.middle, hn::Max(run.front, run.back)));
            const Ints first = find_interval<kind>(transfer, least);
            const auto seen =
                hn::And(hn::Gt(run.length, zero), shows_something<kind>(transfer, first, largest));
            if (hn::AllFalse(d, seen)) {
                store_run(no_sum<false>(), colored, begin, block);
                continue;
            }
            straighten(run);
            Segment& segment = segments[count];
            segment = segment_of<kind>(transfer, run.front, run.back, run.length, seen);
            if (colored) {
                const auto set = [&](const TableRun& part, EntryPlaces& places) HWY_ATTR {
                    set_places(transfer, part.cell, part.length, places);
                };
                set(segment.first, first_places[count]);
                if (segment.some_cut) set(segment.last, last_places[count]);
            }
            slabs[count++] = begin;
        }
        for (int i = 0; colored && i < count; ++i) {
            const Segment& segment = segments[i];
            look_up_entries(transfer, first_places[i], segment.seen, first_entries[i]);
            if (segment.some_cut)
                look_up_entries(transfer, last_places[i], segment.cut, last_entries[i]);
        }
        for (int i = 0; i < count; ++i) {
            SegmentEntries<lit> entries;
            if (colored) entries.first = load_entry(first_entries[i]);
            if (colored && segments[i].some_cut) entries.last = load_entry(last_entries[i]);
            store_run(integrate_segment<lit>(transfer, colored, segments[i], entries), colored,
                      slabs[i], block);
        }
    }
}

// Integrates the whole block. Lit plans have tables.
template <Lookup kind>
HWY_INLINE void integrate_runs(const TileTransfer& transfer, bool colored, const SlicePlan& plan,
                               SlabBlock& block) {
    if (colored && plan.lighting)
        return integrate_by_table<kind, true>(transfer, colored, plan.nan_transparent, block);
    if (kind != Lookup::one || !plan.linear)
        return integrate_by_table<kind, false>(transfer, colored, plan.nan_transparent, block);
    for (int i = block.from; i < block.end; ++i) {
        RunScalars run = run_scalars(block, i, plan.nan_transparent);
        straighten(run);
        store_run(integrate_linear(transfer, colored, run), colored, i, block);
    }
}

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
