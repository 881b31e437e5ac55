// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "reference/cubic.h"

namespace lamina {

// Consecutive segments of one ray, front to back, on each of which the scalar is a cubic.
struct SegmentBatch {
    static constexpr std::size_t capacity = 32;
    static constexpr std::size_t room = capacity + 8;  // vectors may write beyond the last segment

    alignas(64) double scalar[4][room];  // Cubic, coefficient by coefficient
    alignas(64) double lo[room];         // the scalar stays inside [lo, hi] up to rounding
    alignas(64) double hi[room];
    alignas(64) double length[room];  // > 0, in world units
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
