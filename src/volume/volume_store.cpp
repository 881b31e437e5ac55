// SPDX-License-Identifier: Apache-2.0
#include "volume/volume_store.h"

namespace lamina {
namespace {

// Share of the memory limit that bricks may take until it is known what drawing takes.
constexpr double first_share = 0.25;

}  // namespace

VolumeStore::VolumeStore(const Grid& grid, SampleType type,
                         std::unique_ptr<const SampleSource> source)
    : size_(grid.size),
      type_(type),
      source_(std::move(source)),
      bricks_(grid.size, static_cast<std::size_t>(BrickCache::sample_count) * bytes_of(type),
              [this](std::span<const BrickCache::Wanted> wanted) { fill(wanted); }) {
    bricks_.set_capacity(
        static_cast<std::uint64_t>(first_share * static_cast<double>(memory_limit())));
}

void VolumeStore::fill(std::span<const BrickCache::Wanted> wanted) const {
    with_sample_type(type_, [&](auto zero) {
        using T = decltype(zero);
        const BrickPlaces places{size_, bricks_.count(), {0, 0, 0}};
        read_adjacent_bricks<T>(
            *source_, places, wanted, 0,
            [](const BrickCache::Wanted& brick, const auto& first, const SampleWindow<T>& window) {
                T* to = reinterpret_cast<T*>(brick.to);
                for (std::int64_t z = 0; z < BrickCache::samples; ++z) {
                    for (std::int64_t y = 0; y < BrickCache::samples; ++y) {
                        window.copy_row(first[0], first[1] + y, first[2] + z, BrickCache::samples,
                                        to);
                        to += BrickCache::row;
                    }
                }
            });
    });
}

namespace {

using Triple = std::array<std::int64_t, 3>;

// Tells if all samples of the brick that holds a cell are equal; sets `value` to its minimum.
bool is_one_value(const MinMaxBricks* bricks, const Triple& lower, double& value) {
    if (bricks == nullptr || bricks->non_finite > 0) return false;
    Triple brick{};
    for (std::size_t axis = 0; axis < 3; ++axis)
        brick[axis] = std::min(lower[axis] / MinMaxBricks::edge, bricks->count[axis] - 1);
    const ValueRange range = bricks->at(brick[0], brick[1], brick[2]);
    value = range.lo;
    return range.lo == range.hi;
}

// Returns the samples at a cell's corners, x fastest. `samples`: from the first corner on; `step`:
// distances, in samples, from there to the upper corners along x, y and z.
template <typename T>
std::array<double, 8> corners_in(const T* samples, const Triple& step) {
    std::array<double, 8> corners{};
    for (int i = 0; i < 8; ++i) {
        corners[static_cast<std::size_t>(i)] = static_cast<double>(
            samples[(i & 1) * step[0] + (i >> 1 & 1) * step[1] + (i >> 2) * step[2]]);
    }
    return corners;
}

template <typename T>
std::array<double, 8> corners_in_files(const VolumeStore& store, const Triple& lower,
                                       const Triple& upper) {
    SampleBox box{lower, {}};
    for (std::size_t axis = 0; axis < 3; ++axis) box.size[axis] = upper[axis] - lower[axis] + 1;
    std::array<T, 8> samples{};
    store.source().read(box, samples.data());
    const std::int64_t row = box.size[0], slice = row * box.size[1];
    return corners_in(samples.data(), {upper[0] - lower[0], (upper[1] - lower[1]) * row,
                                       (upper[2] - lower[2]) * slice});
}

}  // namespace

std::array<double, 8> scattered_corners(const Volume& volume, const MinMaxBricks* bricks,
                                        const Triple& lower, const Triple& upper) {
    if (volume.in_memory()) {
        const auto& size = volume.grid().size;
        const std::int64_t row = size[0], slice = size[0] * size[1];
        const std::int64_t first = lower[2] * slice + lower[1] * row + lower[0];
        return volume.visit([&](const auto* samples) {
            return corners_in(samples + first, {upper[0] - lower[0], (upper[1] - lower[1]) * row,
                                                (upper[2] - lower[2]) * slice});
        });
    }
    std::array<double, 8> corners{};
    if (double value = 0; is_one_value(bricks, lower, value)) {
        corners.fill(value);
        return corners;
    }
    return with_sample_type(volume.type(), [&](auto zero) {
        return corners_in_files<decltype(zero)>(volume.store(), lower, upper);
    });
}

double scattered_sample(const Volume& volume, const Triple& place) {
    return scattered_corners(volume, nullptr, place, place)[0];
}

}  // namespace lamina
