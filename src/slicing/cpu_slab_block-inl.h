// SPDX-License-Identifier: Apache-2.0
// A block of slabs along a vector of rays; cpu_slab_segments.cpp computes its segments.
#if defined(LAMINA_SLICING_CPU_SLAB_BLOCK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_SLICING_CPU_SLAB_BLOCK_INL_H_
#undef LAMINA_SLICING_CPU_SLAB_BLOCK_INL_H_
#else
#define LAMINA_SLICING_CPU_SLAB_BLOCK_INL_H_
#endif

#include "slicing/cpu_rays-inl.h"

LAMINA_SIMD_BEGIN

// The values of a block: a vector for each slab. Slab i is slab first_slab + i of the view. Only
// `wanted` slabs are computed; from .. end - 1 is the range of consecutive ones in work.
struct SlabBlock {
    static constexpr std::size_t size = block_slabs * most_lanes;
    alignas(64) float edge_scalars[size + most_lanes];  // at the boundaries of slabs
    alignas(64) float scalars[size];                    // in the middles of slabs
    alignas(64) float lengths[size];                    // world units
    alignas(64) float depths[size];                     // optical depths
    alignas(64) float colors[3][size];                  // not used if the plan has a single colour
    // Weights of the light at a segment's front: the front parts (optics/segment_integral.h) of the
    // segment's colour and of its opacity, both divided by its opacity.
    alignas(64) float front_colors[3][size];
    alignas(64) float front_shares[size];
    alignas(64) float edges[size + most_lanes];  // depths of boundaries, from the block's front on
    alignas(64) float middles[size];             // depths of the slabs' middles
    // Optical depths in double precision, for codes; world lengths until extinction is known.
    alignas(64) double precise_depths[size];
    int first_slab, from, end;
    BlockMask wanted;
};

constexpr std::size_t at(int slab) {
    return static_cast<std::size_t>(slab) * most_lanes;
}

// Copy optical depths that were computed in float to precise_depths.
LAMINA_INLINE void set_precise_depths(int first, int end, SlabBlock& block) {
    for (int i = first; i < end; ++i)
        store(Float64(load<Float>(block.depths + at(i))), block.precise_depths + at(i));
}
inline void set_precise_depths(SlabBlock& block) {
    for_each_range(block.wanted, [&](int first, int end)
                                     LAMINA_LAMBDA { set_precise_depths(first, end, block); });
}

// Sets optical depths and colours of wanted slabs; if `precise`, precise_depths, too. Returns the
// number of segments longer than 0.
std::int64_t set_segments(const CpuSlabs& slabs, const CpuBrickView& brick,
                          const PacketRays& packet, bool colored, bool precise, SlabBlock& block);

// Handles slabs first .. end - 1, which lie in a region of one colour and extinction: the first
// slab gets the optical depth of all, and the others are no longer wanted.
void set_constant_range(const CpuSlabs& slabs, const OpticalProperties& optics,
                        const PacketRays& packet, bool colored, int first, int end,
                        SlabBlock& block);

LAMINA_SIMD_END

#endif
