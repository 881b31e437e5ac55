// SPDX-License-Identifier: Apache-2.0
#include "meshing/trilinear_field.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/parallel.h"
#include "volume/sample_source.h"
#include "volume/volume_store.h"

namespace lamina {
namespace {

std::vector<double> planes_along(std::int64_t samples, double first, double last) {
    std::vector<double> planes;
    if (samples == 1) return {first, last};
    if (first < 0) planes.push_back(first);
    for (std::int64_t i = 0; i < samples; ++i) planes.push_back(static_cast<double>(i));
    if (first < 0) planes.push_back(last);
    return planes;
}

std::vector<float> samples_of(const Volume& volume) {
    const std::int64_t count = volume.grid().sample_count();
    std::vector<float> copy(static_cast<std::size_t>(count));
    const auto convert = [](auto sample) { return static_cast<float>(sample); };
    if (volume.in_memory()) {
        volume.visit([&](const auto* samples) {
            std::transform(samples, samples + count, copy.begin(), convert);
        });
        return copy;
    }
    const auto& size = volume.grid().size;
    with_sample_type(volume.type(), [&](auto zero) {
        std::vector<decltype(zero)> layer(static_cast<std::size_t>(size[0] * size[1]));
        auto to = copy.begin();
        for (std::int64_t z = 0; z < size[2]; ++z) {
            volume.store().source().read({{0, 0, z}, {size[0], size[1], 1}}, layer.data());
            to = std::transform(layer.begin(), layer.end(), to, convert);
        }
    });
    return copy;
}

}  // namespace

TrilinearField::TrilinearField(const Volume& volume) : size_(volume.grid().size) {
    const MinMaxBricks bricks = measure_bricks(volume);
    if (bricks.non_finite > 0) {
        fail("{} of {} samples are NaN or infinite: no mesh can follow them", bricks.non_finite,
             volume.grid().sample_count());
    }
    range_ = bricks.whole;
    const glm::dvec3 first = volume.grid().index_min(), last = volume.grid().index_max();
    for (int axis = 0; axis < 3; ++axis) {
        if (size_[axis] > std::numeric_limits<std::int32_t>::max() - 2) {
            fail("the volume has {} samples along axis {}: expected fewer than 2^31", size_[axis],
                 axis);
        }
        planes_[axis] = planes_along(size_[axis], first[axis], last[axis]);
        shift_[axis] = size_[axis] > 1 && first[axis] < 0 ? 1 : 0;
    }
    samples_ = samples_of(volume);
}

TrilinearField::Cell TrilinearField::cell_of(const glm::dvec3& index) const {
    Cell cell{};
    for (int axis = 0; axis < 3; ++axis) {
        const double last = cell_count(axis) - 1;
        const double plane = size_[axis] == 1 ? 0 : std::floor(index[axis]) + shift_[axis];
        cell[axis] = static_cast<std::int32_t>(std::clamp(plane, 0.0, last));
    }
    return cell;
}

double TrilinearField::at_plane(const Cell& plane) const {
    std::array<std::int64_t, 3> sample{};
    for (int axis = 0; axis < 3; ++axis) {
        sample[axis] = std::clamp<std::int64_t>(plane[axis] - shift_[axis], 0, size_[axis] - 1);
    }
    return samples_[static_cast<std::size_t>((sample[2] * size_[1] + sample[1]) * size_[0] +
                                             sample[0])];
}

TrilinearField::Corners TrilinearField::corners(const Cell& cell) const {
    Corners values{};
    for (std::size_t corner = 0; corner < 8; ++corner) {
        values[corner] = at_plane({cell[0] + static_cast<std::int32_t>(corner & 1),
                                   cell[1] + static_cast<std::int32_t>((corner >> 1) & 1),
                                   cell[2] + static_cast<std::int32_t>(corner >> 2)});
    }
    return values;
}

double TrilinearField::at(const glm::dvec3& index) const {
    const Cell cell = cell_of(index);
    Corners v = corners(cell);
    for (int axis = 2; axis >= 0; --axis) {
        const double lo = planes_[axis][cell[axis]], hi = planes_[axis][cell[axis] + 1];
        const double t = (index[axis] - lo) / (hi - lo);
        for (int i = 0; i < (1 << axis); ++i) v[i] += t * (v[i + (1 << axis)] - v[i]);
    }
    return v[0];
}

}  // namespace lamina
