// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace lamina {

// Consecutive segments of one ray, front to back, on each of which the scalar is linear.
struct LinearBatch {
    static constexpr std::size_t capacity = 32;

    alignas(64) double front[capacity];  // scalars
    alignas(64) double back[capacity];
    alignas(64) double length[capacity];  // > 0, in world units
    std::size_t count = 0;

    void add(double at_front, double at_back, double world_length) {
        front[count] = at_front;
        back[count] = at_back;
        length[count] = world_length;
        ++count;
    }
};

}  // namespace lamina
