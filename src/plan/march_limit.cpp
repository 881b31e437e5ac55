// SPDX-License-Identifier: Apache-2.0
#include "plan/march_limit.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <vector>

#include "facts/drawn_range.h"

namespace lamina {
namespace {

constexpr int most_rounds = 65535;
constexpr int spare_rounds = 64;    // of what else a fragment does
constexpr int search_cells = 1024;  // of the range: where searches for an interval start

// Rounds of one search: knots in the fullest cell, and one to see that it is done.
int search_rounds(const TransferFunction& transfer_function, const ValueRange& range) {
    assert(range.hi > range.lo);
    std::vector<int> knots(search_cells, 0);
    for (const TransferKnot& knot : transfer_function.knots()) {
        if (knot.value < range.lo || knot.value > range.hi) continue;
        const double share = (knot.value - range.lo) / (range.hi - range.lo);
        ++knots[static_cast<std::size_t>(std::min<double>(share * search_cells, search_cells - 1))];
    }
    return 1 + *std::ranges::max_element(knots);
}

}  // namespace

int most_marched_slabs(const Scene& scene, const Facts& facts, const Capabilities& capabilities) {
    if (!capabilities.software || capabilities.tiles) return std::numeric_limits<int>::max();
    const int search =
        search_rounds(scene.transfer_function, drawn_range(scene.transfer_function, facts.range));
    // The slab, a leap, and for tables four searches and up to three runs
    // (shaders/slicing/leaf.frag, shaders/optics/preintegration.glsl).
    const bool table = scene.slice.classification == Classification::preintegrated;
    const int rounds = 2 + (table ? 4 * search + 4 : search);
    return std::max(1, (most_rounds - spare_rounds) / rounds);
}

}  // namespace lamina
