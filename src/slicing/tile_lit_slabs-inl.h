// SPDX-License-Identifier: Apache-2.0
// Light on the slabs of a block (docs/numerics.md, section 10): in the middle of each, or at both
// ends and linear between them.
#if defined(LAMINA_SLICING_TILE_LIT_SLABS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_SLICING_TILE_LIT_SLABS_INL_H_
#undef LAMINA_SLICING_TILE_LIT_SLABS_INL_H_
#else
#define LAMINA_SLICING_TILE_LIT_SLABS_INL_H_
#endif

#include "slicing/cpu_fetch-inl.h"
#include "slicing/cpu_light-inl.h"
#include "slicing/tile_block-inl.h"

LAMINA_SIMD_BEGIN

// Fetches gradients ahead, for one pixel in each row and column.
LAMINA_INLINE void prefetch_gradients(const TileBrick& brick, const std::int32_t* index) {
    if (brick.pages != nullptr) return;
    for (std::size_t lane = 0; lane < Float::lanes; lane += TileGrid::block + 1) {
        const auto* const at = brick.gradients + static_cast<std::size_t>(index[lane]);
        __builtin_prefetch(at);
        __builtin_prefetch(at + static_cast<std::size_t>(brick.slice));
    }
}

// Calls visit(i, effect of light at point_at(i)) for i = first .. end - 1, in stages of a few.
template <std::size_t channels, PointKind kind, class PointAt, class Visit>
LAMINA_INLINE void visit_light(const TileLight& light, const TileBrick& brick, const EyeLanes& eye,
                               int first, int end, const PointAt& point_at, const Visit& visit) {
    constexpr int stage = 8;
    alignas(64) std::int32_t index[stage][most_lanes];
    Float shares[stage][3];
    for (int begin = first; begin < end; begin += stage) {
        const int count = std::min(stage, end - begin);
        for (int i = 0; i < count; ++i) {
            const Cell cell = cell_at<kind>(brick, point_at(begin + i));
            store(cell.index, index[i]);
            prefetch_gradients(brick, index[i]);
            for (int axis = 0; axis < 3; ++axis) shares[i][axis] = cell.share[axis];
        }
        for (int i = 0; i < count; ++i) {
            const PointGradient gradient = gradient_at(brick, light, index[i], shares[i]);
            visit(begin + i,
                  effect_of<channels>(light, gradient.along, gradient.smallest_square, eye.to_eye));
        }
    }
}

template <std::size_t channels>
LAMINA_INLINE void light_middle(const EffectLanes<channels>& effect, int slab, SlabBlock& block) {
    for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t k = channels == 1 ? 0 : c;
        float* const at_slab = block.colors[c] + at(slab);
        const Float color = load<Float>(at_slab);
        const Float lit = color + color * effect.change[k] + effect.highlight[k];
        store(max(lit, 0), at_slab);
    }
}

template <std::size_t channels>
LAMINA_INLINE void light_ends(const EffectLanes<channels>& front, const EffectLanes<channels>& back,
                              int slab, SlabBlock& block) {
    const Float share = load<Float>(block.front_shares + at(slab));
    for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t k = channels == 1 ? 0 : c;
        float* const at_slab = block.colors[c] + at(slab);
        const Float color = load<Float>(at_slab);
        const Float of_front = load<Float>(block.front_colors[c] + at(slab));
        const Float changed =
            color * back.change[k] + of_front * (front.change[k] - back.change[k]);
        const Float highlight =
            back.highlight[k] + share * (front.highlight[k] - back.highlight[k]);
        store(max(color + changed + highlight, 0), at_slab);
    }
}

// Lights the run's visible slabs, those with `shows(i)`. `middle(i)` and `edge(i)` are the points
// in the middle of a slab and in front of it.
template <std::size_t channels, PointKind kind, class Middle, class Edge, class Shows>
LAMINA_INLINE void light_slabs(const TileSlabs& slabs, const TileBrick& brick,
                               const PacketRays& rays, const Middle& middle, const Edge& edge,
                               const Shows& shows, SlabBlock& block) {
    const TileLight& light = *slabs.light;
    const EyeLanes eye = eye_of(light, rays);
    const bool ends = slabs.plan->integrates_runs();
    for (int first = block.from; first < block.end;) {
        if (!shows(first)) {
            ++first;
            continue;
        }
        int end = first + 1;
        while (end < block.end && shows(end)) ++end;
        if (ends) {
            EffectLanes<channels> front;
            visit_light<channels, kind>(light, brick, eye, first, end + 1, edge,
                                        [&](int i, const EffectLanes<channels>& effect)
                                            LAMINA_LAMBDA {
                                                if (i > first)
                                                    light_ends(front, effect, i - 1, block);
                                                front = effect;
                                            });
        } else {
            visit_light<channels, kind>(light, brick, eye, first, end, middle,
                                        [&](int i, const EffectLanes<channels>& effect)
                                            LAMINA_LAMBDA { light_middle(effect, i, block); });
        }
        first = end;
    }
}

template <PointKind kind, class Middle, class Edge, class Shows>
LAMINA_INLINE void light_run(const TileSlabs& slabs, const TileBrick& brick, const PacketRays& rays,
                             const Middle& middle, const Edge& edge, const Shows& shows,
                             SlabBlock& block) {
    if (slabs.light->gray)
        return light_slabs<1, kind>(slabs, brick, rays, middle, edge, shows, block);
    light_slabs<3, kind>(slabs, brick, rays, middle, edge, shows, block);
}

LAMINA_SIMD_END

#endif
