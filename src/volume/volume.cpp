// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include "base/enum_words.h"
#include "lamina/volume.h"

namespace lamina {
namespace {

// An axis with one sample has no extent between samples, so it is a voxel whatever the file says.
bool spans_voxels(const Grid& grid, int axis) {
    return grid.size[axis] == 1 || grid.centering[axis] == Centering::cell;
}

}  // namespace

glm::dvec3 Grid::index_min() const {
    glm::dvec3 corner{first_sample()};
    for (int axis = 0; axis < 3; ++axis) corner[axis] -= spans_voxels(*this, axis) ? 0.5 : 0.0;
    return corner;
}

glm::dvec3 Grid::index_max() const {
    glm::dvec3 corner{0};
    for (int axis = 0; axis < 3; ++axis) {
        const double last = static_cast<double>(size[axis] - 1) + first_sample();
        corner[axis] = spans_voxels(*this, axis) ? last + 0.5 : last;
    }
    return corner;
}

glm::dvec3 Grid::index_origin() const {
    if (lookup == VolumeLookup::linear) return origin;
    return origin - first_sample() * (step[0] + step[1] + step[2]);
}

glm::dvec3 Grid::to_world(const glm::dvec3& index) const {
    return index_origin() + index.x * step[0] + index.y * step[1] + index.z * step[2];
}

glm::dvec3 Grid::to_index(const glm::dvec3& world) const {
    return direction_to_index(world - index_origin());
}

glm::dvec3 Grid::direction_to_index(const glm::dvec3& world) const {
    // The columns of the matrix are orthogonal, so its inverse projects on each of them. A column
    // is first scaled by a power of two, so that its square neither vanishes nor overflows.
    glm::dvec3 index{0};
    for (int axis = 0; axis < 3; ++axis) {
        const glm::dvec3& along = step[axis];
        const double largest = std::max({std::abs(along.x), std::abs(along.y), std::abs(along.z)});
        const double scale = std::scalbn(1.0, -std::ilogb(largest));
        const glm::dvec3 scaled = scale * along;
        index[axis] = glm::dot(world, scaled) / glm::dot(scaled, scaled) * scale;
    }
    return index;
}

Grid::Bounds Grid::bounds() const {
    const glm::dvec3 corners[2] = {index_min(), index_max()};
    Bounds box;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 world = to_world(
            {corners[corner & 1].x, corners[(corner >> 1) & 1].y, corners[(corner >> 2) & 1].z});
        box.min = corner == 0 ? world : glm::min(box.min, world);
        box.max = corner == 0 ? world : glm::max(box.max, world);
    }
    return box;
}

std::size_t bytes_of(SampleType type) {
    constexpr std::size_t bytes[] = {1, 2, 2, 4};
    return bytes[static_cast<std::size_t>(type)];
}

const char* name_of(SampleType type) {
    static constexpr const char* words[] = {"uint8", "int16", "uint16", "float"};
    return word_of(type, words);
}

}  // namespace lamina
