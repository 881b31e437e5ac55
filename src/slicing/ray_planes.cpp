// SPDX-License-Identifier: Apache-2.0
#include "slicing/ray_planes.h"

#include <glm/geometric.hpp>

namespace lamina {

std::vector<RayPlane> ray_planes(const std::vector<IndexPlane>& clip, const Grid& grid,
                                 const View& view, const Slabs& slabs) {
    const bool perspective = view.projection == Projection::perspective;
    const glm::dvec3 middle = grid.to_index(view.eye + slabs.near * view.forward);
    const glm::dvec3 forward = grid.direction_to_index(view.forward);
    const glm::dvec3 column = grid.direction_to_index(view.pixel * view.right);
    const glm::dvec3 row = grid.direction_to_index(-view.pixel * view.up);
    const double spread = perspective ? slabs.near : 1, turn = perspective ? 1 : 0;
    std::vector<RayPlane> planes;
    for (const IndexPlane& plane : clip) {
        const double by_column = glm::dot(plane.normal, column);
        const double by_row = glm::dot(plane.normal, row);
        planes.push_back({plane.distance(middle), spread * by_column, spread * by_row,
                          glm::dot(plane.normal, forward), turn * by_column, turn * by_row});
    }
    return planes;
}

}  // namespace lamina
