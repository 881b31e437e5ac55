// SPDX-License-Identifier: Apache-2.0
// Light on the slabs of a block (docs/numerics.md, section 10): in the middle of each, or at both
// ends and linear between them.
#if defined(LAMINA_SLICING_TILE_LIT_SLABS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_SLICING_TILE_LIT_SLABS_INL_H_
#undef LAMINA_SLICING_TILE_LIT_SLABS_INL_H_
#else
#define LAMINA_SLICING_TILE_LIT_SLABS_INL_H_
#endif

#include <hwy/highway.h>

#include "slicing/tile_block-inl.h"
#include "slicing/tile_light-inl.h"
#include "slicing/tile_scalars-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {

// Fetches the gradients ahead, of one pixel in each row and column.
HWY_INLINE void prefetch_gradients(const TileBrick& brick, const std::int32_t* index) {
    if (brick.pages != nullptr) return;
    for (std::size_t lane = 0; lane < hn::Lanes(FloatTag()); lane += TileGrid::block + 1) {
        const auto* const at = brick.gradients + static_cast<std::size_t>(index[lane]);
        __builtin_prefetch(at);
        __builtin_prefetch(at + static_cast<std::size_t>(brick.slice));
    }
}

// Calls visit(i, effect of light at point_at(i)) for i = first .. end - 1, in stages of a few.
template <std::size_t channels, PointKind kind, class PointAt, class Visit>
HWY_INLINE void visit_light(const TileLight& light, const TileBrick& brick, const EyeLanes& eye,
                            int first, int end, const PointAt& point_at, const Visit& visit) {
    constexpr int stage = 8;
    alignas(64) std::int32_t index[stage][most_lanes];
    Floats shares[stage][3];
    for (int begin = first; begin < end; begin += stage) {
        const int count = std::min(stage, end - begin);
        for (int i = 0; i < count; ++i) {
            const Cell cell = cell_at<kind>(brick, point_at(begin + i));
            hn::Store(cell.index, IntTag(), index[i]);
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
HWY_INLINE void light_middle(const EffectLanes<channels>& effect, int slab, SlabBlock& block) {
    for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t k = channels == 1 ? 0 : c;
        float* const at_slab = block.colors[c] + at(slab);
        const Number color = load_number(at_slab);
        const Number lit = color + color * effect.change[k] + effect.highlight[k];
        store_number(max(lit, Number(0)), at_slab);
    }
}

template <std::size_t channels>
HWY_INLINE void light_ends(const EffectLanes<channels>& front, const EffectLanes<channels>& back,
                           int slab, SlabBlock& block) {
    const Number share = load_number(block.front_shares + at(slab));
    for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t k = channels == 1 ? 0 : c;
        float* const at_slab = block.colors[c] + at(slab);
        const Number color = load_number(at_slab);
        const Number of_front = load_number(block.front_colors[c] + at(slab));
        const Number changed =
            color * back.change[k] + of_front * (front.change[k] - back.change[k]);
        const Number highlight =
            back.highlight[k] + share * (front.highlight[k] - back.highlight[k]);
        store_number(max(color + changed + highlight, Number(0)), at_slab);
    }
}

// Lights the run's slabs that show something: `shows(i)`. `middle(i)` and `edge(i)` are the points
// in the middle of a slab and in front of it.
template <std::size_t channels, PointKind kind, class Middle, class Edge, class Shows>
HWY_INLINE void light_slabs(const TileSlabs& slabs, const TileBrick& brick, const PacketRays& rays,
                            const Middle& middle, const Edge& edge, const Shows& shows,
                            SlabBlock& block) {
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
                                        [&](int i, const EffectLanes<channels>& effect) HWY_ATTR {
                                            if (i > first) light_ends(front, effect, i - 1, block);
                                            front = effect;
                                        });
        } else {
            visit_light<channels, kind>(light, brick, eye, first, end, middle,
                                        [&](int i, const EffectLanes<channels>& effect)
                                            HWY_ATTR { light_middle(effect, i, block); });
        }
        first = end;
    }
}

template <PointKind kind, class Middle, class Edge, class Shows>
HWY_INLINE void light_run(const TileSlabs& slabs, const TileBrick& brick, const PacketRays& rays,
                          const Middle& middle, const Edge& edge, const Shows& shows,
                          SlabBlock& block) {
    if (slabs.light->gray)
        return light_slabs<1, kind>(slabs, brick, rays, middle, edge, shows, block);
    light_slabs<3, kind>(slabs, brick, rays, middle, edge, shows, block);
}

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
