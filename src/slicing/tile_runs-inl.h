// SPDX-License-Identifier: Apache-2.0
// Pre-integration of a block's slabs: vector form of the use of the table in
// shaders/slicing/segment.glsl.
#if defined(LAMINA_SLICING_TILE_RUNS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_SLICING_TILE_RUNS_INL_H_
#undef LAMINA_SLICING_TILE_RUNS_INL_H_
#else
#define LAMINA_SLICING_TILE_RUNS_INL_H_
#endif

#include "executors/tile_knot_table-inl.h"
#include "slicing/tile_block-inl.h"

LAMINA_SIMD_BEGIN

// The normalised scalars of a segment. If one of them is NaN, scalars and length are 0.
struct RunScalars {
    Float front, middle, back, length;
};

LAMINA_INLINE RunScalars run_scalars(const SlabBlock& block, int i, bool nan_transparent) {
    RunScalars run{load<Float>(block.edge_scalars + at(i)), load<Float>(block.scalars + at(i)),
                   load<Float>(block.edge_scalars + at(i + 1)), load<Float>(block.lengths + at(i))};
    if (!nan_transparent) return run;
    const Float sum = run.front + run.middle + run.back;
    const FloatMask numbers = sum == sum;
    for (Float* const v : {&run.front, &run.middle, &run.back, &run.length})
        *v = zero_unless(numbers, *v);
    return run;
}

// Makes the scalar linear along the segment: both ends are moved so that its mean is the mean of
// the parabola through the three scalars.
LAMINA_INLINE void straighten(RunScalars& run) {
    const Float mean = 0.5f * (run.front + run.back);
    const Float bend = 2.0f / 3.0f * (run.middle - mean);
    run.front = clamp01(run.front + bend);
    run.back = clamp01(run.back + bend);
}

// Integrates in closed form if the transfer function is one linear piece, as
// shaders/slicing/segment.glsl does.
LAMINA_INLINE RunSum integrate_linear(const TileTransfer& transfer, bool colored,
                                      const RunScalars& run) {
    constexpr Lookup one = Lookup::one;
    const Int piece(0);
    const Float front = share_of_interval<one>(transfer, piece, run.front),
                back = share_of_interval<one>(transfer, piece, run.back);
    const Float p = optics_at<one>(transfer, 3, piece, front) * run.length,
                q = optics_at<one>(transfer, 3, piece, back) * run.length;
    RunSum sum;
    sum.depth = 0.5f * p + 0.5f * q;
    if (!colored) return sum;
    const Float opacity = opacity_from_depth(sum.depth);
    const Float weight = min(thin_front_weight(p, q), opacity);
    const Float of_front = weight / max(opacity, 1e-37f);
    const Float place = mix(back, front, of_front);
    for (std::size_t channel = 0; channel < 3; ++channel)
        sum.color[channel] = optics_at<one>(transfer, channel, piece, place);
    return sum;
}

LAMINA_INLINE void store_run(const RunSum& run, bool colored, int slab, SlabBlock& block) {
    store(run.depth, block.depths + at(slab));
    if (!colored) return;
    for (std::size_t channel = 0; channel < 3; ++channel)
        store(run.color[channel], block.colors[channel] + at(slab));
}
LAMINA_INLINE void store_run(const LitSum& run, bool colored, int slab, SlabBlock& block) {
    const RunSum& unlit = run;
    store_run(unlit, colored, slab, block);
    for (std::size_t channel = 0; channel < 3; ++channel)
        store(run.front_color[channel], block.front_colors[channel] + at(slab));
    store(run.front_share, block.front_shares + at(slab));
}

// Integrates by the table, in stages of a few slabs, so that many entries are looked up at a time.
// A segment is invisible if the transfer function shows nothing between the least and the largest
// of its three scalars.
template <Lookup kind, bool lit>
LAMINA_INLINE void integrate_by_table(const TileTransfer& transfer, bool colored,
                                      bool nan_transparent, SlabBlock& block) {
    constexpr int stage = 8;
    Segment segments[stage];
    EntryPlaces first_places[stage], last_places[stage];
    EntryNumbers<lit> first_entries[stage], last_entries[stage];
    int slabs[stage];
    for (int begin = block.from; begin < block.end;) {
        int count = 0;
        for (; count < stage && begin < block.end; ++begin) {
            RunScalars run = run_scalars(block, begin, nan_transparent);
            const Float least = clamp01(min(run.middle, min(run.front, run.back)));
            const Float largest = clamp01(max(run.middle, max(run.front, run.back)));
            const Int first = find_interval<kind>(transfer, least);
            const FloatMask seen =
                (run.length > 0) & shows_something<kind>(transfer, first, largest);
            if (none_of(seen)) {
                store_run(no_sum<false>(), colored, begin, block);
                continue;
            }
            straighten(run);
            Segment& segment = segments[count];
            segment = segment_of<kind>(transfer, run.front, run.back, run.length, seen);
            if (colored) {
                const auto set = [&](const TableRun& part, EntryPlaces& places) LAMINA_LAMBDA {
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
LAMINA_INLINE void integrate_runs(const TileTransfer& transfer, bool colored, const SlicePlan& plan,
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

LAMINA_SIMD_END

#endif
