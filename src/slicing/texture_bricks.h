// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <vector>

#include "lamina/grid.h"
#include "plan/plan.h"
#include "scene/camera.h"

namespace lamina {

// Returns the box of index space that a brick draws: that of its samples and, at the volume's
// border, everything beyond them.
IndexBox box_of(const TextureBrick& brick, const Grid& grid);

// A place beyond all others, as a float, which shaders get.
inline constexpr glm::dvec3 no_last_face{double{std::numeric_limits<float>::max()}};

// Returns the last face of a part of the volume on each axis, in the part's own index space, if the
// volume ends there; else no_last_face. `end`: the part's largest coordinates. The volume's box is
// closed: rays that run in its faces are inside, as in the reference tracer. Rays in a face between
// two parts belong to the part that begins there.
glm::dvec3 last_face_of(const glm::dvec3& end, const glm::dvec3& first, const Grid& grid);

// A row of a brick along x. Places begin .. end - 1 hold the volume's own samples, from number
// `first` on. Other places repeat the nearest of these.
struct BrickRow {
    std::size_t first;
    std::int64_t begin, end;

    template <typename Texel>
    void repeat_ends(Texel* row, std::int64_t size) const {
        std::fill(row, row + begin, row[begin]);
        std::fill(row + end, row + size, row[end - 1]);
    }
};
BrickRow row_of(const TextureBrick& brick, const Grid& grid, std::int64_t y, std::int64_t z);

// Sorts the indices of `bricks` so that along every ray the bricks come in the plan's order. It
// takes memory only if `numbers` is not yet large enough.
void set_visibility_order(const std::vector<TextureBrick>& bricks, const Grid& grid,
                          const View& view, Order order, std::vector<std::size_t>& numbers);

}  // namespace lamina
