// SPDX-License-Identifier: Apache-2.0
// A block of slabs along the rays of a vector of pixels.
#if defined(LAMINA_SLICING_TILE_BLOCK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_SLICING_TILE_BLOCK_INL_H_
#undef LAMINA_SLICING_TILE_BLOCK_INL_H_
#else
#define LAMINA_SLICING_TILE_BLOCK_INL_H_
#endif

#include "slicing/cpu_rays-inl.h"

LAMINA_SIMD_BEGIN

// The values of a block, one vector for each slab. Slab i of a block is slab first_slab + i of the
// view. The slabs that are `wanted` are computed run by run; a run is from .. end - 1.
struct SlabBlock {
    static constexpr std::size_t size = tile_block_slabs * most_lanes;
    // At the boundaries of slabs, for pre-integration.
    alignas(64) float edge_scalars[size + most_lanes];
    alignas(64) float scalars[size];    // in the middles of slabs
    alignas(64) float lengths[size];    // world units
    alignas(64) float depths[size];     // optical depths
    alignas(64) float colors[3][size];  // not used if the plan has a single colour
    // Front parts of light (optics/segment_integral.h) per opacity: of colours, of opacity.
    alignas(64) float front_colors[3][size];
    alignas(64) float front_shares[size];
    alignas(64) float edges[size + most_lanes];  // depths of boundaries from the block's front on
    alignas(64) float middles[size];
    // Optical depths for codes, which are computed in double precision.
    alignas(64) double precise_depths[size];
    int first_slab, from, end;
    BlockMask wanted;
};

constexpr std::size_t at(int slab) {
    return static_cast<std::size_t>(slab) * most_lanes;
}

LAMINA_SIMD_END

#endif
