// SPDX-License-Identifier: Apache-2.0
#include "plan/curve_choice.h"

#include <fmt/format.h>

#include <algorithm>

#include "facts/drawn_range.h"
#include "optics/curved_pieces.h"

namespace lamina {

// Curves may cost this share of max_error.
constexpr double curve_share = 0.25;

CurveChoice choose_curves(const Scene& scene, const Facts& facts, const SlicePlan& slice,
                          const Capabilities& capabilities) {
    if (!slice.integrates_cells() || !capabilities.tiles) return {};
    const TransferFunction& function = scene.transfer_function;
    if (std::ranges::none_of(function.knots(), &TransferKnot::smooth)) return {};
    const double error = largest_curve_error * std::max(facts.max_color, 1.0);
    if (error > curve_share * scene.max_error) return {};
    const ValueRange range = drawn_range(function, facts.range);
    const std::size_t straight = pieces_between(function, range.lo, range.hi, false).size();
    const std::size_t curved = pieces_between(function, range.lo, range.hi, true).size();
    if (curved == straight) return {};
    return {
        true, error,
        fmt::format(
            "{} cubics follow {} straight pieces of the transfer function, which meet at smooth "
            "points: off by at most {:.2g} / 255",
            curved, straight, error)};
}

}  // namespace lamina
