// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>

#include "lamina/export.h"

namespace lamina {

enum class Centering { node, cell };

// What the axes of the world mean where the file says so: where x, y and z grow to in a patient's
// body. All have z to the head.
enum class WorldAxes {
    unnamed,
    left_posterior_superior,
    right_anterior_superior,
    left_anterior_superior
};

// Where the samples of a regular grid lie in the world. In index space sample (i, j, k) lies at (i,
// j, k). The box that is rendered is chosen axis by axis: with Centering::node it spans the
// samples; with Centering::cell it spans whole voxels, half a voxel more at each end, where the
// border value repeats.
struct LAMINA_API Grid {
    std::array<std::int64_t, 3> size{1, 1, 1};
    std::array<Centering, 3> centering{Centering::cell, Centering::cell, Centering::cell};
    glm::dvec3 origin{0};  // world position of sample (0, 0, 0)
    std::array<glm::dvec3, 3> step{glm::dvec3{1, 0, 0}, glm::dvec3{0, 1, 0},
                                   glm::dvec3{0, 0, 1}};  // orthogonal
    WorldAxes axes = WorldAxes::unnamed;                  // for the automatic camera alone

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
