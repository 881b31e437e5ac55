// SPDX-License-Identifier: Apache-2.0
// A block of slabs along the rays of a vector of pixels.
#if defined(LAMINA_SLICING_TILE_BLOCK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_SLICING_TILE_BLOCK_INL_H_
#undef LAMINA_SLICING_TILE_BLOCK_INL_H_
#else
#define LAMINA_SLICING_TILE_BLOCK_INL_H_
#endif

#include <hwy/highway.h>

#include "slicing/tile_rays-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {

// Slab i of a block is slab first_slab + i; those `wanted` are computed run by run, slabs from ..
// end - 1 at a time. A vector a slab.
struct SlabBlock {
    static constexpr std::size_t size = tile_block_slabs * most_lanes;
    alignas(64) float edge_scalars[size + most_lanes];  // of pre-integration
    alignas(64) float scalars[size];                    // in the middle
    alignas(64) float lengths[size];                    // world units
    alignas(64) float depths[size];                     // optical
    alignas(64) float colors[3][size];                  // not where the plan has a single one
    alignas(64) float edges[size + most_lanes];         // from the block's front on
    alignas(64) float middles[size];
    // Of codes, which are computed in double precision: optical depths.
    alignas(64) double precise_depths[size];
    int first_slab, from, end;
    BlockMask wanted;
};

constexpr std::size_t at(int slab) {
    return static_cast<std::size_t>(slab) * most_lanes;
}

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
