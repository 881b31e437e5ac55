// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>

#include "lamina/export.h"

namespace lamina {

// Which box belongs to the samples along an axis: with `node` it spans the samples, with `cell` it
// spans whole voxels, half a voxel more at each end, and the border value repeats there. A single
// sample along an axis is a voxel with either.
enum class Centering { node, cell };

// Directions in a patient's body to which the world's x, y and z grow, if the file says so. In all
// of them z grows to the head.
enum class WorldAxes {
    unnamed,
    left_posterior_superior,
    right_anterior_superior,
    left_anterior_superior
};

// Places of the samples of a regular grid in the world. In index space sample (i, j, k) lies at (i,
// j, k). The box that is rendered is chosen axis by axis.
struct LAMINA_API Grid {
    std::array<std::int64_t, 3> size{1, 1, 1};
    std::array<Centering, 3> centering{Centering::node, Centering::node, Centering::node};
    glm::dvec3 origin{0};  // world position of sample (0, 0, 0)
    std::array<glm::dvec3, 3> step{glm::dvec3{1, 0, 0}, glm::dvec3{0, 1, 0},
                                   glm::dvec3{0, 0, 1}};  // orthogonal
    WorldAxes axes = WorldAxes::unnamed;                  // used by the automatic camera only

    std::int64_t sample_count() const { return size[0] * size[1] * size[2]; }
    glm::dvec3 index_min() const;  // of the box, index space
    glm::dvec3 index_max() const;
    glm::dvec3 to_world(const glm::dvec3& index) const;
    glm::dvec3 to_index(const glm::dvec3& world) const;
    glm::dvec3 direction_to_index(const glm::dvec3& world) const;  // for directions: no translation

    struct Bounds {
        glm::dvec3 min{0}, max{0};
    };
    Bounds bounds() const;  // axis-aligned, world
};

}  // namespace lamina
