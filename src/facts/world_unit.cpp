// SPDX-License-Identifier: Apache-2.0
#include "facts/world_unit.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace lamina {

double world_unit(double diagonal) {
    return diagonal > 0 ? std::scalbn(1.0, -std::ilogb(diagonal)) : 1;
}

double box_diagonal(const Grid& grid) {
    return glm::distance(grid.to_world(grid.index_min()), grid.to_world(grid.index_max()));
}

Grid in_units(Grid grid, double unit) {
    grid.origin *= unit;
    for (glm::dvec3& step : grid.step) step *= unit;
    return grid;
}

View in_units(View view, double unit) {
    view.eye *= unit;
    if (view.projection == Projection::orthographic) view.pixel *= unit;
    return view;
}

TransferFunction in_units(const TransferFunction& transfer_function, double unit) {
    return transfer_function.attenuated(1 / unit);
}

}  // namespace lamina
