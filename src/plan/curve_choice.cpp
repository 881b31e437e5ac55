// SPDX-License-Identifier: Apache-2.0
#include "plan/curve_choice.h"

#include <fmt/format.h>

#include <algorithm>

#include "optics/curved_pieces.h"

namespace lamina {

// Curves may cost this share of max_error.
constexpr double curve_share = 0.25;

CurveChoice choose_curves(const Scene& scene, const Facts& facts, const SlicePlan& slice,
                          const Capabilities& capabilities) {
    if (!slice.integrates_cells() || !capabilities.tiles) return {};
    if (facts.curves == facts.pieces) return {};
    const double error = largest_curve_error * std::max(facts.max_color, 1.0);
    if (error > curve_share * scene.max_error) return {};
    return {
        true, error,
        fmt::format(
            "{} cubics follow {} straight pieces of the transfer function, which meet at smooth "
            "points: off by at most {:.2g} / 255",
            facts.curves, facts.pieces, error)};
}

}  // namespace lamina
