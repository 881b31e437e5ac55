// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "volume/sample_source.h"

namespace lamina {

// A box of a volume's samples in memory, x fastest. What lies beyond the box repeats its border;
// where the box reaches the volume's border, that is what the volume has there.
template <typename T>
struct SampleWindow {
    SampleBox box;
    const T* samples = nullptr;

    const T* row(std::int64_t y, std::int64_t z) const {
        return samples + (inside(2, z) * box.size[1] + inside(1, y)) * box.size[0];
    }
    T at(std::int64_t x, std::int64_t y, std::int64_t z) const { return row(y, z)[inside(0, x)]; }

    // The samples (x, y, z) .. (x + count - 1, y, z).
    void copy_row(std::int64_t x, std::int64_t y, std::int64_t z, std::int64_t count, T* to) const {
        const T* const from = row(y, z);
        const std::int64_t begin = std::clamp<std::int64_t>(box.first[0] - x, 0, count);
        const std::int64_t end =
            std::clamp<std::int64_t>(box.first[0] + box.size[0] - x, begin, count);
        std::fill(to, to + begin, from[0]);
        std::copy(from + (x + begin - box.first[0]), from + (x + end - box.first[0]), to + begin);
        std::fill(to + end, to + count, from[box.size[0] - 1]);
    }

  private:
    std::int64_t inside(std::size_t axis, std::int64_t at) const {
        return std::clamp<std::int64_t>(at - box.first[axis], 0, box.size[axis] - 1);
    }
};

}  // namespace lamina
