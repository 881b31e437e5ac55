// SPDX-License-Identifier: Apache-2.0
#include "facts/index_plane.h"

#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "scene/half_space.h"

namespace lamina {

double IndexPlane::distance(const glm::dvec3& index) const {
    return glm::dot(normal, index) + offset;
}

double IndexPlane::least_distance(const glm::dvec3& min, const glm::dvec3& max) const {
    return distance(0.5 * (min + max)) - glm::dot(glm::abs(normal), 0.5 * (max - min));
}

double IndexPlane::largest_distance(const glm::dvec3& min, const glm::dvec3& max) const {
    return distance(0.5 * (min + max)) + glm::dot(glm::abs(normal), 0.5 * (max - min));
}

std::vector<IndexPlane> index_planes(const Clip& clip, const Grid& grid) {
    std::vector<IndexPlane> planes;
    for (const HalfSpace& half : half_spaces(clip)) {
        glm::dvec3 slope(0);
        for (std::size_t axis = 0; axis < 3; ++axis)
            slope[static_cast<int>(axis)] = glm::dot(half.normal, grid.step[axis]);
        const double length = std::hypot(slope.x, slope.y, slope.z);  // voxels may be tiny
        planes.push_back(
            {slope / length, glm::dot(half.normal, grid.origin - half.point) / length});
    }
    return planes;
}

std::vector<IndexPlane> cutting_planes(std::vector<IndexPlane> planes, const Grid& grid) {
    const glm::dvec3 min = grid.index_min(), max = grid.index_max();
    std::erase_if(planes,
                  [&](const IndexPlane& plane) { return plane.least_distance(min, max) >= 0; });
    return planes;
}

}  // namespace lamina
