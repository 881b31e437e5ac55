// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "volume/min_max_bricks.h"

namespace lamina {

// Which bricks of MinMaxBricks the transfer function shows something in.
struct OccupiedBricks {
    std::array<std::int64_t, 3> count{0, 0, 0};
    std::vector<std::uint8_t> shown;  // 0, 1; x fastest

    // Whether one of them touches the part of the volume between two points of index space. Its
    // outermost bricks also hold what lies beyond them.
    bool any_in(const glm::dvec3& min, const glm::dvec3& max) const {
        std::array<std::int64_t, 3> first{}, last{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto at = static_cast<int>(axis);
            const auto end = static_cast<double>(count[axis] - 1);
            constexpr double edge = MinMaxBricks::edge;
            first[axis] = static_cast<std::int64_t>(std::clamp(min[at] / edge, 0.0, end));
            last[axis] = static_cast<std::int64_t>(std::clamp(max[at] / edge, 0.0, end));
        }
        for (std::int64_t z = first[2]; z <= last[2]; ++z) {
            for (std::int64_t y = first[1]; y <= last[1]; ++y) {
                const std::uint8_t* const row = shown.data() + (z * count[1] + y) * count[0];
                for (std::int64_t x = first[0]; x <= last[0]; ++x) {
                    if (row[x] != 0) return true;
                }
            }
        }
        return false;
    }
};

}  // namespace lamina
