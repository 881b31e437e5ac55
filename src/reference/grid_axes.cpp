// SPDX-License-Identifier: Apache-2.0
#include "reference/grid_axes.h"

#include <algorithm>
#include <cmath>

namespace lamina {
namespace {

GridAxes::Axis scaled_axis(const glm::dvec3& step) {
    const double largest = std::max({std::abs(step.x), std::abs(step.y), std::abs(step.z)});
    int exponent = 0;
    std::frexp(largest, &exponent);
    --exponent;  // to [1, 2): an offset of one subnormal number from a face must survive
    GridAxes::Axis axis;
    DoubleDouble square;
    for (int i = 0; i < 3; ++i) {
        axis.scaled[i] = std::scalbn(step[i], -exponent);
        square = square + exact_product(axis.scaled[i], axis.scaled[i]);
    }
    axis.inverse_square = DoubleDouble{1, 0} / square;
    axis.unscale = std::scalbn(1.0, -exponent);
    return axis;
}

}  // namespace

GridAxes::GridAxes(const Grid& grid)
    : origin(grid.origin),
      lowest(grid.index_min()),
      highest(grid.index_max()),
      axes{scaled_axis(grid.step[0]), scaled_axis(grid.step[1]), scaled_axis(grid.step[2])} {}

}  // namespace lamina
