// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>

#include "lamina/volume.h"
#include "volume/brick_cache.h"
#include "volume/min_max_bricks.h"
#include "volume/sample_source.h"

namespace lamina {

// The samples of a volume in its files, with a cache of bricks. Safe from any thread.
class VolumeStore {
  public:
    VolumeStore(const Grid& grid, SampleType type, std::unique_ptr<const SampleSource> source);

    const SampleSource& source() const { return *source_; }
    const std::array<std::int64_t, 3>& size() const { return size_; }
    SampleType type() const { return type_; }
    BrickCache& bricks() const { return bricks_; }

    // Returns one sample; reads the brick that holds it.
    template <typename T>
    T sample(std::int64_t x, std::int64_t y, std::int64_t z) const {
        return corners<T>({x, y, z}, {x, y, z})[0];
    }

    // Returns the samples at a cell's corners, x fastest; `upper`: at most one more than `lower`.
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

// Acts like a pointer to the first sample of a volume that stays in its files; x changes fastest.
template <typename T>
class SamplesInFiles {
  public:
    SamplesInFiles() = default;  // samples of no volume
    explicit SamplesInFiles(const VolumeStore& store, std::int64_t first = 0)
        : store_(&store), first_(first) {}

    T operator[](std::int64_t number) const {
        number += first_;
        const auto& size = store_->size();
        return store_->template sample<T>(number % size[0], number / size[0] % size[1],
                                          number / (size[0] * size[1]));
    }
    // Returns the samples at a cell's corners, x fastest. The cell is at most one step wide.
    std::array<T, 8> corners(const std::array<std::int64_t, 3>& lower,
                             const std::array<std::int64_t, 3>& upper) const {
        return store_->template corners<T>(lower, upper);
    }
    friend SamplesInFiles operator+(const SamplesInFiles& samples, std::int64_t steps) {
        return SamplesInFiles(*samples.store_, samples.first_ + steps);
    }

  private:
    const VolumeStore* store_ = nullptr;
    std::int64_t first_ = 0;
};

// Calls visitor(a pointer to the first sample, or SamplesInFiles): for work on few samples.
template <typename Visitor>
decltype(auto) visit_samples(const Volume& volume, const Visitor& visitor) {
    if (volume.in_memory()) return volume.visit(visitor);
    return with_sample_type(volume.type(), [&](auto zero) {
        return visitor(SamplesInFiles<decltype(zero)>(volume.store()));
    });
}

// Throws Error if the files of a volume that stays in them have changed since it was opened.
inline void check_unchanged(const Volume& volume) {
    if (!volume.in_memory()) volume.store().source().check_unchanged();
}

// Returns the samples at the corners of a cell, x fastest; `upper`: at most one more than `lower`.
// If the volume stays in its files, only these samples are read, no bricks of the cache; none are
// read if `bricks` (the volume's, or null) shows that all samples of the cell's brick are equal.
std::array<double, 8> scattered_corners(const Volume& volume, const MinMaxBricks* bricks,
                                        const std::array<std::int64_t, 3>& lower,
                                        const std::array<std::int64_t, 3>& upper);

// Returns one sample, which is read like scattered_corners().
double scattered_sample(const Volume& volume, const std::array<std::int64_t, 3>& place);

}  // namespace lamina
