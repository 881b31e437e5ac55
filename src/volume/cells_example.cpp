// SPDX-License-Identifier: Apache-2.0
#include "volume/examples.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <vector>

#include "base/client.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "volume/generate.h"
#include "volume/gradient_noise.h"

// Places are in micrometres, 0 in the middle of the ball.
namespace lamina {
namespace {

using glm::dvec3;

constexpr std::array<std::int64_t, 3> cells_size{144, 144, 72};
const dvec3 cells_spacing{0.3, 0.3, 0.6};
constexpr double ball_radius = 17;
constexpr double cell_distance = 8.6;  // between neighbours
constexpr double cell_jitter = 0.22;   // of a cell's place, in distances
constexpr double cell_reach = 5.6;     // from a cell's middle to where nothing is left of it
constexpr double depth_loss = 0.012;   // of light per micrometre below the top

struct Cell {
    dvec3 center, axis;     // of the nucleus; `axis` is its long one
    double radius, length;  // half the nucleus' width and length
    double brightness;
};

// Maps 16 bits to -1..1.
double signed_share(std::uint64_t bits, int part) {
    return static_cast<double>(bits >> (16 * part) & 0xffff) / 32767.5 - 1;
}

// The cells lie near the points of a lattice of cubes and their middles.
std::vector<Cell> cells_in_ball() {
    std::vector<Cell> cells;
    constexpr double edge = cell_distance * 1.1547005383792515;  // of a cube: 2 / sqrt(3)
    for (int i = 0; i < 2 * 7 * 7 * 7; ++i) {
        const std::uint64_t bits = mixed_bits(static_cast<std::uint64_t>(i) * 3 + 0xce11);
        const std::uint64_t more = mixed_bits(bits);
        const dvec3 lattice = dvec3{i / 2 % 7 - 3, i / 14 % 7 - 3, i / 98 - 3} + 0.5 * (i % 2);
        const dvec3 moved{signed_share(bits, 0), signed_share(bits, 1), signed_share(bits, 2)};
        Cell cell;
        cell.center = edge * lattice + cell_jitter * cell_distance * moved;
        if (glm::length(cell.center) > ball_radius - 3) continue;
        const dvec3 turned{signed_share(more, 0), signed_share(more, 1), signed_share(more, 2)};
        cell.axis = glm::normalize(turned + dvec3{0.01, 0, 0});
        cell.radius = 2.5 + 0.4 * signed_share(bits, 3);
        cell.length = cell.radius * (1.3 + 0.25 * signed_share(more, 3));
        cell.brightness = 0.72 + 0.2 * signed_share(mixed_bits(more), 0);
        cells.push_back(cell);
    }
    return cells;
}

// Returns the distance from a nucleus' middle, 1 at its border.
double within_nucleus(const Cell& cell, const dvec3& p) {
    const dvec3 from = p - cell.center;
    const double along = glm::dot(from, cell.axis);
    const double across2 = std::max(0.0, glm::dot(from, from) - along * along);
    return std::sqrt(across2 / (cell.radius * cell.radius) +
                     along * along / (cell.length * cell.length));
}

// Returns the light of a dividing cell: two plates of chromosomes that part along the axis.
double divided(const Cell& cell, const dvec3& p, double grain) {
    const dvec3 from = p - cell.center;
    const double along = std::abs(glm::dot(from, cell.axis)) - 2.1;
    const double across2 =
        std::max(0.0, glm::dot(from, from) - glm::dot(from, cell.axis) * glm::dot(from, cell.axis));
    const double plate = std::sqrt(across2 / 7.3 + along * along / 0.5);
    return smooth_step((1.15 + 0.5 * grain - plate) / 0.5);
}

class Cells {
  public:
    // Returns the share of the brightest light. `grain`: noise around 0.
    double at(const dvec3& p, double grain) const {
        double nearest = 1e9, second = 1e9;
        std::size_t index = 0;
        for (std::size_t i = 0; i < cells_.size(); ++i) {
            const dvec3 from = p - cells_[i].center;
            const double distance2 = glm::dot(from, from);
            if (distance2 < nearest) {
                second = nearest;
                nearest = distance2;
                index = i;
            } else {
                second = std::min(second, distance2);
            }
        }
        const double reached = std::sqrt(nearest);
        if (reached > cell_reach + 2) return 0;
        const Cell& cell = cells_[index];
        const double to_wall = std::min(0.5 * (std::sqrt(second) - reached), cell_reach - reached);
        const double wall = portable_exp(-std::min(to_wall * to_wall / 0.16, 60.0));
        const double inside = smooth_step(to_wall / 0.6 + 0.5);
        const double nucleus =
            index == dividing ? divided(cell, p, grain)
                              : smooth_step((1 - within_nucleus(cell, p)) / 0.22) *
                                    (0.8 + 0.45 * std::clamp(grain, -1.0, 0.6)) * cell.brightness;
        return std::max(nucleus, 0.17 * wall + 0.06 * inside * (1 + grain));
    }

  private:
    static constexpr std::size_t dividing = 20;  // near the middle of the top

    std::vector<Cell> cells_ = cells_in_ball();
};

}  // namespace

Volume cells_volume() {
    Grid grid;
    grid.size = cells_size;
    grid.centering.fill(Centering::cell);
    for (int axis = 0; axis < 3; ++axis) {
        const auto i = static_cast<std::size_t>(axis);
        grid.step[i] = dvec3(0);
        grid.step[i][axis] = cells_spacing[axis];
        grid.origin[axis] = -0.5 * cells_spacing[axis] * static_cast<double>(cells_size[i] - 1);
    }
    grid.unit = "um";
    const std::shared_ptr<void> samples =
        filled_memory(static_cast<std::size_t>(grid.sample_count()));
    auto* const values = static_cast<std::uint8_t*>(samples.get());
    const Cells cells;
    Progress progress("making the cells", cells_size[2]);
    parallel_for(cells_size[1] * cells_size[2], 8, [&](std::int64_t row) {
        dvec3 p = grid.origin + cells_spacing * dvec3{0, row % cells_size[1], row / cells_size[1]};
        std::vector<double> grain(static_cast<std::size_t>(cells_size[0]));
        constexpr double grain_size = 1.1;  // of chromatin
        GradientNoise(0xce115).add_row(p.x / grain_size + 0.3, cells_spacing.x / grain_size,
                                       p.y / grain_size, p.z / grain_size + 0.3, 1.3,
                                       static_cast<int>(grain.size()), grain.data());
        const double lit = portable_exp(depth_loss * (p.z + grid.origin.z));
        for (std::int64_t x = 0; x < cells_size[0]; ++x) {
            const std::int64_t i = row * cells_size[0] + x;
            p.x = grid.origin.x + cells_spacing.x * static_cast<double>(x);
            const double light =
                8 + 225 * lit * std::max(0.0, cells.at(p, grain[static_cast<std::size_t>(x)]));
            // Counted photons vary by the root of their number; a photon is 0.3 codes here.
            const double noise =
                normal_number(mixed_bits(static_cast<std::uint64_t>(i) + (0xce11ull << 32)));
            values[i] = static_cast<std::uint8_t>(
                std::clamp(light + 0.55 * std::sqrt(light) * noise, 0.0, 255.0) + 0.5);
        }
        if (row % cells_size[1] == 0) progress.advance();
    });
    return {grid, SampleType::uint8, samples};
}

}  // namespace lamina
