// SPDX-License-Identifier: Apache-2.0
// The parts of rays that lie in one cell each, stored densely: a vector of parts is computed at a
// time, whatever rays they belong to.
#if defined(LAMINA_SLICING_TILE_CELL_PARTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_SLICING_TILE_CELL_PARTS_INL_H_
#undef LAMINA_SLICING_TILE_CELL_PARTS_INL_H_
#else
#define LAMINA_SLICING_TILE_CELL_PARTS_INL_H_
#endif

#include <cstddef>
#include <cstdint>

#include "simd/members-inl.h"

LAMINA_SIMD_BEGIN

// Some steps of the rays of a few packets. In each step a ray crosses one cell, or several that
// show nothing or are constant.
struct CellParts {
    // Packets side by side: each waits for its own results.
    static constexpr std::size_t most_packets = 2;
    static constexpr int most_steps = 32;
    static constexpr std::size_t capacity = (most_steps * most_packets + 1) * most_lanes;

    // Where the ray enters the cell, from 0 to 1, and how far it goes in it.
    alignas(64) float place[3][capacity];
    alignas(64) float change[3][capacity];
    alignas(64) float length[capacity];        // world units
    alignas(64) std::int32_t index[capacity];  // of the cell's lowest corner
    // The normalised scalar from entry to exit: cubic[0] + t (cubic[1] + ...), t from 0 to 1.
    alignas(64) float cubic[4][capacity];
    // Of parts that are lit: the direction to the eye.
    alignas(64) float to_eye[3][capacity];
    // Associated colour, opacity and optical depth that the part adds to its ray.
    alignas(64) float color[3][capacity];
    alignas(64) float opacity[capacity];
    alignas(64) float depth[capacity];

    StoredLanes lanes[most_steps][most_packets];  // rays that have a part in this step
    int steps;
    std::size_t count;

    void clear() {
        steps = 0;
        count = 0;
    }
};

LAMINA_SIMD_END

#endif
