// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <vector>

#include "lamina/clip.h"
#include "lamina/grid.h"

namespace lamina {

// A plane of a clip in a grid's index space: points at distances >= 0 are kept.
struct IndexPlane {
    glm::dvec3 normal{0};  // of length 1
    double offset = 0;

    double distance(const glm::dvec3& index) const;
    // Returns this plane in an index space that begins at sample `first` of its own.
    IndexPlane seen_from(const glm::dvec3& first) const { return {normal, distance(first)}; }
    // Return the least and the largest distance of a box's points.
    double least_distance(const glm::dvec3& min, const glm::dvec3& max) const;
    double largest_distance(const glm::dvec3& min, const glm::dvec3& max) const;

    friend bool operator==(const IndexPlane&, const IndexPlane&) = default;
};

// Returns all planes of the clip, the box's six last.
std::vector<IndexPlane> index_planes(const Clip& clip, const Grid& grid);
// Returns those of `planes` that cut something off the grid's box.
std::vector<IndexPlane> cutting_planes(std::vector<IndexPlane> planes, const Grid& grid);

}  // namespace lamina
