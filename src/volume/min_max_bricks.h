// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "lamina/volume.h"

namespace lamina {

// A range of finite scalars; lo > hi where there are none.
struct ValueRange {
    double lo = 1;
    double hi = 0;
    bool empty() const { return lo > hi; }

    friend bool operator==(const ValueRange&, const ValueRange&) = default;
};

// The volume in bricks of `edge` cells. A brick's range covers every sample that interpolation
// inside the brick can touch: its own samples and the next one along each axis. So neighbours share
// their border samples. The bricks take an eighth of the memory of a volume of bytes.
struct MinMaxBricks {
    static constexpr std::int64_t edge = 4;

    // A ValueRange in float32, which holds every sample type exactly.
    struct Range {
        float lo = 1;
        float hi = 0;
        operator ValueRange() const { return {lo, hi}; }
    };

    std::array<std::int64_t, 3> count{0, 0, 0};  // bricks along each axis
    std::vector<Range> ranges;                   // x fastest
    ValueRange whole;
    std::int64_t non_finite = 0;  // NaN and infinite samples in the volume

    ValueRange at(std::int64_t x, std::int64_t y, std::int64_t z) const {
        return ranges[static_cast<std::size_t>((z * count[1] + y) * count[0] + x)];
    }
};

MinMaxBricks measure_bricks(const Volume& volume);  // parallel

}  // namespace lamina
