// SPDX-License-Identifier: Apache-2.0
#include "volume_files/volume_grid.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "base/error.h"

namespace lamina {
namespace {

// Directions count as orthogonal up to this cosine: headers print some 6 digits, and it moves
// samples by less than a hundredth of a voxel over 1000 voxels.
constexpr double orthogonal_cosine = 1e-5;

// Steps outside of this range would overflow or vanish when squared.
constexpr double shortest_step = 1e-100;
constexpr double longest_step = 1e100;

}  // namespace

void check_grid(const std::string& file, const Grid& grid, const GridWords& words) {
    for (std::size_t i = 0; i < 3; ++i) {
        const double length = std::hypot(grid.step[i].x, grid.step[i].y, grid.step[i].z);
        if (!(length >= shortest_step && length <= longest_step)) {
            fail("{}: axis {}: found a distance of {} between samples, expected one from {} to {}",
                 file, i, length, shortest_step, longest_step);
        }
        if (!(std::abs(grid.origin[static_cast<int>(i)]) <= longest_step)) {
            fail("{}: {}: found {}, expected finite numbers up to {}", file, words.origin,
                 grid.origin[static_cast<int>(i)], longest_step);
        }
    }
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3;
        const double cosine = glm::dot(glm::normalize(grid.step[i]), glm::normalize(grid.step[j]));
        if (std::abs(cosine) > orthogonal_cosine) {
            fail("{}: {}: axes {} and {} meet at {:.4f} degrees, expected 90", file,
                 words.directions, std::min(i, j), std::max(i, j),
                 glm::degrees(std::acos(std::clamp(cosine, -1.0, 1.0))));
        }
    }
}

void turn_to_lps(Grid& grid, WorldAxes axes) {
    if (axes == WorldAxes::unnamed) return;
    const glm::dvec3 turn{axes == WorldAxes::right_anterior_superior ? -1 : 1,
                          axes == WorldAxes::left_posterior_superior ? 1 : -1, 1};
    grid.origin *= turn;
    for (glm::dvec3& step : grid.step) step *= turn;
    grid.axes = WorldAxes::left_posterior_superior;
}

}  // namespace lamina
