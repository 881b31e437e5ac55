// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lamina {

// Finds points by their exact coordinates (0 equals -0; a point with NaN is never found). Where
// several points lie at one place, as on both sides of a crack, none is found there.
class PointTable {
  public:
    // `points`: what the indices refer to; may grow, and outlives the table.
    explicit PointTable(const std::vector<glm::dvec3>& points) : points_(points) {}

    void add(std::int32_t point);
    void add_all();  // all points that there are now
    // The index of the only added point there, or -1.
    std::int32_t find(const glm::dvec3& place) const;

  private:
    std::size_t slot_of(const glm::dvec3& place) const;
    void grow(std::size_t slots);

    const std::vector<glm::dvec3>& points_;
    // A hash table with linear probing, its size a power of two, at most half full. 0: empty; i +
    // 1: the point i; -(i + 1): several points, the first of which is i.
    std::vector<std::int32_t> slots_;
    std::size_t used_ = 0;
};

}  // namespace lamina
