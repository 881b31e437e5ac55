// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "lamina/volume.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// The field of a volume on its box, in index space: trilinear between planes of samples. Along a
// `node` axis the planes lie at 0, ..., n - 1. Along a `cell` axis they lie at -1/2, 0, ..., n - 1,
// n - 1/2, and the outer ones repeat the border value. Along an axis of one sample they lie at -1/2
// and 1/2.
class TrilinearField {
  public:
    using Cell = std::array<std::int32_t, 3>;  // between plane i and plane i + 1 of each axis
    using Corners = std::array<double, 8>;     // values at a cell's corners: x + 2y + 4z

    // Keeps a copy of the samples as float, which holds each of the sample types exactly. Throws
    // Error for volumes with samples that are not finite, or with 2^31 planes along an axis.
    explicit TrilinearField(const Volume& volume);

    std::span<const double> planes(int axis) const { return planes_[axis]; }
    std::int32_t cell_count(int axis) const {
        return static_cast<std::int32_t>(planes_[axis].size()) - 1;
    }
    glm::dvec3 min() const { return {planes_[0].front(), planes_[1].front(), planes_[2].front()}; }
    glm::dvec3 max() const { return {planes_[0].back(), planes_[1].back(), planes_[2].back()}; }
    const ValueRange& range() const { return range_; }

    // The cell that contains `index`; for a point outside the box, the nearest cell. On a plane
    // between two cells it is the one with the higher index.
    Cell cell_of(const glm::dvec3& index) const;
    Corners corners(const Cell& cell) const;
    double at_plane(const Cell& plane) const;  // the value where three planes meet
    double at(const glm::dvec3& index) const;

  private:
    std::array<std::vector<double>, 3> planes_;
    std::array<std::int32_t, 3> shift_{0, 0, 0};  // planes before the first sample
    std::array<std::int64_t, 3> size_{1, 1, 1};
    std::vector<float> samples_;
    ValueRange range_;
};

}  // namespace lamina
