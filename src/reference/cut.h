// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "reference/cubic.h"

namespace lamina {

// Consecutive segments of one ray, front to back, on each of which the scalar is a cubic.
struct SegmentBatch {
    static constexpr std::size_t capacity = 32;

    alignas(64) double scalar[4][capacity];  // Cubic, coefficient by coefficient
    alignas(64) double lo[capacity];         // the scalar stays inside [lo, hi] up to rounding
    alignas(64) double hi[capacity];
    alignas(64) double length[capacity];  // > 0, in world units
    // Its number in the CellBatch that make_segments() made it from.
    alignas(64) std::int64_t cell[capacity];
    std::size_t count = 0;

    void add(const Cubic& cubic, double least, double most, double world_length) {
        for (std::size_t power = 0; power < 4; ++power) scalar[power][count] = cubic.c[power];
        lo[count] = least;
        hi[count] = most;
        length[count] = world_length;
        ++count;
    }
};

}  // namespace lamina
