// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "lamina/volume.h"
#include "volume/brick_ranges.h"
#include "volume/sample_window.h"

namespace lamina {

// A range of finite scalars; lo > hi where there are none.
struct ValueRange {
    double lo = 1;
    double hi = 0;
    bool empty() const { return lo > hi; }

    friend bool operator==(const ValueRange&, const ValueRange&) = default;
};
ValueRange joined(const ValueRange& a, const ValueRange& b);

// The volume in bricks of `edge` cells. A brick's range covers every sample that interpolation
// inside the brick can touch: its own samples and the next one along each axis. So neighbours share
// their border samples.
struct MinMaxBricks {
    static constexpr std::int64_t edge = 4;

    std::array<std::int64_t, 3> count{0, 0, 0};  // bricks along each axis
    BrickRanges ranges;                          // x fastest
    ValueRange whole;
    std::int64_t non_finite = 0;  // NaN and infinite samples in the volume

    // Bricks of a volume, with ranges that are still to be set.
    static MinMaxBricks of(const Grid& grid, SampleType type);

    ValueRange range(std::size_t number) const {
        const BrickRange found = ranges[number];
        return {found.lo, found.hi};
    }
    ValueRange at(std::int64_t x, std::int64_t y, std::int64_t z) const {
        return range(static_cast<std::size_t>((z * count[1] + y) * count[0] + x));
    }
};

MinMaxBricks measure_bricks(const Volume& volume);  // parallel

// Sets the ranges of a block of bricks, first .. first + count - 1 along each axis, from a window
// that holds their samples, and returns what the block adds to `whole` and `non_finite`. Blocks may
// be set from several threads.
struct BlockExtent {
    ValueRange whole;
    std::int64_t non_finite = 0;
};
template <typename T>
BlockExtent measure_block(const Grid& grid, const SampleWindow<T>& window,
                          const std::array<std::int64_t, 3>& first,
                          const std::array<std::int64_t, 3>& count, MinMaxBricks& bricks);

}  // namespace lamina
