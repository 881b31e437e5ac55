// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>

#include "lamina/volume.h"
#include "volume/brick_cache.h"
#include "volume/sample_source.h"

namespace lamina {

// The samples of a volume that stay in its files, and those bricks of them that were used last.
// Safe from any thread.
class VolumeStore {
  public:
    VolumeStore(const Grid& grid, SampleType type, std::unique_ptr<const SampleSource> source);

    const SampleSource& source() const { return *source_; }
    const std::array<std::int64_t, 3>& size() const { return size_; }
    SampleType type() const { return type_; }
    // Bricks of samples of the volume's type.
    BrickCache& bricks() const { return bricks_; }

    // One sample, by its place: reads the brick that holds it.
    template <typename T>
    T sample(std::int64_t x, std::int64_t y, std::int64_t z) const {
        return corners<T>({x, y, z}, {x, y, z})[0];
    }

    // The samples at the corners of a cell, x fastest; `upper`: at most one more than `lower`.
    template <typename T>
    std::array<T, 8> corners(const std::array<std::int64_t, 3>& lower,
                             const std::array<std::int64_t, 3>& upper) const {
        std::array<std::int64_t, 3> brick{};
        std::array<std::size_t, 3> step{};  // to the upper corners
        std::size_t place = 0;
        constexpr std::array<std::int64_t, 3> steps{1, BrickCache::row, BrickCache::slice};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            brick[axis] = std::min(lower[axis] / BrickCache::edge, bricks_.count()[axis] - 1);
            place += static_cast<std::size_t>((lower[axis] - brick[axis] * BrickCache::edge) *
                                              steps[axis]);
            step[axis] = static_cast<std::size_t>((upper[axis] - lower[axis]) * steps[axis]);
        }
        const std::uint32_t number = bricks_.number(brick[0], brick[1], brick[2]);
        const auto held = bricks_.hold(1, [&](std::size_t) { return number; });
        const std::byte* const from = bricks_.at(number);
        std::array<T, 8> found;
        for (std::size_t i = 0; i < 8; ++i) {
            const std::size_t at = place + ((i & 1) != 0 ? step[0] : 0) +
                                   ((i & 2) != 0 ? step[1] : 0) + ((i & 4) != 0 ? step[2] : 0);
            std::memcpy(&found[i], from + at * sizeof(T), sizeof(T));
        }
        return found;
    }

  private:
    void fill(std::span<const BrickCache::Wanted> wanted) const;

    std::array<std::int64_t, 3> size_;
    SampleType type_;
    std::unique_ptr<const SampleSource> source_;
    mutable BrickCache bricks_;
};

}  // namespace lamina
