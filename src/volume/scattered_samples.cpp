// SPDX-License-Identifier: Apache-2.0
#include "volume/scattered_samples.h"

#include <algorithm>

#include "volume/volume_store.h"
#include "volume/with_sample_type.h"

namespace lamina {
namespace {

using Triple = std::array<std::int64_t, 3>;

// The range of the brick that holds a cell, if that is one value.
bool is_one_value(const MinMaxBricks* bricks, const Triple& lower, double& value) {
    if (bricks == nullptr || bricks->non_finite > 0) return false;
    Triple brick{};
    for (std::size_t axis = 0; axis < 3; ++axis)
        brick[axis] = std::min(lower[axis] / MinMaxBricks::edge, bricks->count[axis] - 1);
    const ValueRange range = bricks->at(brick[0], brick[1], brick[2]);
    value = range.lo;
    return range.lo == range.hi;
}

// The corners of a cell in a box that begins with it.
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
