// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "base/memory.h"
#include "lamina/volume.h"
#include "volume/sample_source.h"

namespace lamina {

// A range of finite scalars in float32, which holds all sample types exactly; lo > hi if empty.
struct BrickRange {
    float lo = 1;
    float hi = 0;
};

// The min/max ranges of a volume's bricks, each stored as two samples of the volume's type: all
// take 1/32 of the volume's memory. At first all are [0, 0], and take no memory.
class BrickRanges {
  public:
    BrickRanges() = default;
    BrickRanges(std::size_t count, SampleType type)
        : count_(count), type_(type), memory_(count * 2 * bytes_of(type)) {}

    std::size_t size() const { return count_; }
    SampleType type() const { return type_; }
    std::size_t byte_count() const { return memory_.size(); }
    std::byte* data() { return memory_.data(); }
    const std::byte* data() const { return memory_.data(); }

    BrickRange operator[](std::size_t i) const {
        return with_sample_type(type_, [&](auto zero) {
            decltype(zero) range[2];
            std::memcpy(range, memory_.data() + i * sizeof range, sizeof range);
            return BrickRange{static_cast<float>(range[0]), static_cast<float>(range[1])};
        });
    }

    // Tells whether the ranges first .. first + count - 1 are all [0, 0]. `count`: 1 or more.
    bool all_zero(std::size_t first, std::size_t count) const {
        const std::size_t each = 2 * bytes_of(type_);
        return lamina::all_zero(memory_.data() + first * each, count * each);
    }

    // Returns a range of 8-bit samples as one number, lo + 256 hi.
    std::size_t byte_pair(std::size_t i) const {
        const auto* const range = reinterpret_cast<const std::uint8_t*>(memory_.data()) + 2 * i;
        return range[0] + (std::size_t{range[1]} << 8);
    }

    // Sets a range. T must be the volume's type.
    template <typename T>
    void set(std::size_t i, T lo, T hi) {
        const T range[2] = {lo, hi};
        std::memcpy(memory_.data() + i * sizeof range, range, sizeof range);
    }

  private:
    std::size_t count_ = 0;
    SampleType type_ = SampleType::uint8;
    ReservedMemory memory_;
};

// A range of finite scalars; lo > hi if there are none.
struct ValueRange {
    double lo = 1;
    double hi = 0;
    bool empty() const { return lo > hi; }

    friend bool operator==(const ValueRange&, const ValueRange&) = default;
};
ValueRange joined(const ValueRange& a, const ValueRange& b);

// The range of values in each brick of edge^3 cells, over all samples that interpolation inside the
// brick can touch: edge + 1 along each axis, so that neighbours share their border samples.
struct MinMaxBricks {
    static constexpr std::int64_t edge = 4;

    std::array<std::int64_t, 3> count{0, 0, 0};  // bricks along each axis
    BrickRanges ranges;                          // x fastest
    ValueRange whole;                            // of all finite samples of the volume
    std::int64_t non_finite = 0;                 // NaN and infinite samples in the volume

    // Makes the bricks of a volume, whose ranges are still to be set.
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

// The range and the non-finite samples of a block of bricks.
struct BlockExtent {
    ValueRange whole;
    std::int64_t non_finite = 0;
};
// Sets the ranges of bricks first .. first + count - 1 along each axis from the samples of `box`.
// Returns what the caller adds to `whole` and `non_finite`. Threads may measure different blocks.
BlockExtent measure_block(const Grid& grid, const SampleBox& box, const void* samples,
                          const std::array<std::int64_t, 3>& first,
                          const std::array<std::int64_t, 3>& count, MinMaxBricks& bricks);

}  // namespace lamina
