// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "lamina/grid.h"
#include "reference/cell_index.h"
#include "reference/cubic.h"
#include "reference/trilinear.h"

namespace lamina {

// A gradient along a ray, component by component, in world space.
using GradientAlong = std::array<Cubic, 3>;

// The gradient field of a volume (docs/numerics.md, section 10): differences of neighbours at the
// samples, trilinear between them, in scalar units per world unit.
template <typename Samples>
class GradientSamples {
  public:
    GradientSamples(const Grid& grid, const Samples& samples)
        : samples_(samples), size_(grid.size) {
        stride_ = {1, size_[0], size_[0] * size_[1]};
        for (std::size_t axis = 0; axis < 3; ++axis)
            axes_[axis] = grid.step[axis] / glm::dot(grid.step[axis], grid.step[axis]);
    }

    // The field in a cell along from + t * step, 0 <= t <= 1, in coordinates of the cell (0..1).
    // Outside the samples the border's gradient repeats.
    GradientAlong along(const CellIndex& cell, const glm::dvec3& from,
                        const glm::dvec3& step) const {
        std::array<CellCorners, 3> corners;
        for (std::size_t corner = 0; corner < 8; ++corner) {
            const glm::dvec3 gradient = at({cell[0] + static_cast<std::int64_t>(corner & 1),
                                            cell[1] + static_cast<std::int64_t>(corner >> 1 & 1),
                                            cell[2] + static_cast<std::int64_t>(corner >> 2)});
            for (int c = 0; c < 3; ++c)
                corners[static_cast<std::size_t>(c)].v[corner] = gradient[c];
        }
        return {corners[0].along(from, step), corners[1].along(from, step),
                corners[2].along(from, step)};
    }

  private:
    glm::dvec3 at(CellIndex index) const {
        std::int64_t offset = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            index[axis] = std::clamp<std::int64_t>(index[axis], 0, size_[axis] - 1);
            offset += index[axis] * stride_[axis];
        }
        glm::dvec3 gradient(0);
        for (std::size_t axis = 0; axis < 3; ++axis)
            gradient += difference(offset, index[axis], axis) * axes_[axis];
        return gradient;
    }

    // Per step of the axis, from the neighbours on both sides; from one side where the other is
    // outside or no number; 0 where both are.
    double difference(std::int64_t offset, std::int64_t index, std::size_t axis) const {
        const auto value = [&](std::int64_t steps) {
            return static_cast<double>(samples_[offset + steps * stride_[axis]]);
        };
        const bool below = index > 0 && std::isfinite(value(-1));
        const bool above = index + 1 < size_[axis] && std::isfinite(value(1));
        if (below && above) return 0.5 * (value(1) - value(-1));
        if (above) return value(1) - value(0);
        if (below) return value(0) - value(-1);
        return 0;
    }

    Samples samples_;
    std::array<std::int64_t, 3> size_, stride_;
    std::array<glm::dvec3, 3> axes_;
};

}  // namespace lamina
