// SPDX-License-Identifier: Apache-2.0
#include "plan/march_limit.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <vector>

#include "facts/drawn_range.h"
#include "plan/light_choice.h"

namespace lamina {
namespace {

constexpr int most_rounds = 65535;
constexpr int spare_rounds = 64;    // rounds for everything else that a fragment does
constexpr int search_cells = 1024;  // parts of the range at which searches for an interval start
// Rays end at an optical depth of 20.7. Cells deeper than .75 are cut: a piece at least as deep as
// half of that takes up to 20 rounds to find and up to 20 more pieces before it, if extinction
// rises from 0 (shaders/slicing/cut_cell.glsl).
constexpr int deep_part_rounds = 8192;

bool is_unlimited(const Capabilities& capabilities) {
    return !capabilities.software || capabilities.tiles;
}

// Returns the rounds of one search: knots in the fullest cell, and one to see that it is done.
int search_rounds(const Scene& scene, const Facts& facts) {
    const ValueRange range = drawn_range(*scene.transfer_function, facts.range);
    assert(range.hi > range.lo);
    std::vector<int> knots(search_cells, 0);
    for (const TransferKnot& knot : scene.transfer_function->knots()) {
        if (knot.value < range.lo || knot.value > range.hi) continue;
        const double share = (knot.value - range.lo) / (range.hi - range.lo);
        ++knots[static_cast<std::size_t>(std::min<double>(share * search_cells, search_cells - 1))];
    }
    return 1 + *std::ranges::max_element(knots);
}

// Counts the slab, a leap, light in the middle or at up to two ends, and for tables four searches
// and up to three pieces (shaders/slicing/slab_march.glsl, slab_light.glsl,
// shaders/preintegration/knot_table.glsl).
int rounds_of_slab(const Scene& scene, const Facts& facts) {
    const int search = search_rounds(scene, facts);
    const bool table = scene.slice.classification == Classification::preintegrated;
    const int light = !scene.lighting ? 0 : table ? 2 : 1;
    return 2 + light + (table ? 4 * search + 4 : search);
}

// Counts the cell, a leap, its light, two searches, and if knots are crossed one for the cell and
// up to three crossings of each (a cubic has three monotone pieces).
double rounds_of_cell(const Scene& scene, const Facts& facts) {
    const auto pieces = 3 * (static_cast<double>(facts.knots) + 1);
    const int light = scene.lighting ? 1 : 0;
    return 2 + light + 2 * search_rounds(scene, facts) + (facts.knots > 0 ? 1 + pieces : 0);
}

// Returns the largest number of cells that a ray crosses between two planes that are `depth` apart:
// one for each plane of the grid, and the first. A direction's sum over axes is at most its length
// by Cauchy and Schwarz.
double most_cells(const Facts& facts, double depth) {
    const glm::dvec3 box = facts.occupied.max - facts.occupied.min;
    glm::dvec3 cells_per_unit;
    for (int axis = 0; axis < 3; ++axis)
        cells_per_unit[axis] = 1 / glm::length(facts.grid.step[static_cast<std::size_t>(axis)]);
    const double along = depth * facts.max_length_per_depth * glm::length(cells_per_unit);
    return std::min(box.x + box.y + box.z, along) + 4;
}

// Returns the rounds that do not depend on the segment's length.
double rounds_at_any_length(const Scene& scene, const Facts& facts) {
    const bool parts_deep_cells = !facts.single_color || scene.lighting;
    return spare_rounds + (parts_deep_cells ? deep_part_rounds : 0) +
           light_rounds(scene, facts.max_color);
}

double exact_rounds(const Scene& scene, const Facts& facts, double share) {
    const double depth = share * (facts.far_depth - facts.near_depth);
    return rounds_at_any_length(scene, facts) +
           most_cells(facts, depth) * rounds_of_cell(scene, facts);
}

}  // namespace

int most_marched_slabs(const Scene& scene, const Facts& facts, const Capabilities& capabilities,
                       int slabs) {
    if (is_unlimited(capabilities)) return std::numeric_limits<int>::max();
    if (scene.slice.classification == Classification::exact)
        return std::max(1, slabs / least_exact_slabs(scene, facts, capabilities));
    return std::max(1, (most_rounds - spare_rounds) / rounds_of_slab(scene, facts));
}

int least_exact_slabs(const Scene& scene, const Facts& facts, const Capabilities& capabilities) {
    if (is_unlimited(capabilities) || facts.occupied.empty()) return 1;
    if (facts.constant && !scene.lighting) return 1;
    const auto fits = [&](int slabs) {
        return exact_rounds(scene, facts, 1.0 / slabs) <= most_rounds;
    };
    int slabs = 1;
    while (!fits(slabs) && slabs < max_slabs) slabs *= 2;
    return slabs;
}

double least_lit_error(const Scene& scene, const Facts& facts, const Capabilities& capabilities) {
    if (is_unlimited(capabilities) || !scene.lighting) return 0;
    const double light = light_rounds(scene, facts.max_color);
    const double others = rounds_at_any_length(scene, facts) - light;
    const double cells = most_cells(facts, 0) * rounds_of_cell(scene, facts);
    return scene.max_error * light / std::max(most_rounds - others - cells, 1.0);
}

}  // namespace lamina
