// SPDX-License-Identifier: Apache-2.0
#include "selftest/pixel_bounds.h"

#include <cmath>

namespace lamina::selftest {
namespace {

Interval over(const Interval& alpha, const Interval& color, const Interval& behind) {
    const auto at = [&](double a, double front, double back) { return a * front + (1 - a) * back; };
    return {std::min(at(alpha.lo, color.lo, behind.lo), at(alpha.hi, color.lo, behind.lo)),
            std::max(at(alpha.lo, color.hi, behind.hi), at(alpha.hi, color.hi, behind.hi))};
}

}  // namespace

PixelBounds composite(const std::vector<PieceBounds>& pieces, const BlendRounding& rounding) {
    constexpr Interval opacities{0, 1};
    PixelBounds pixel;
    for (auto piece = pieces.rbegin(); piece != pieces.rend(); ++piece) {
        if (piece->depth.hi <= 0) continue;  // no fragment, or one of code 0
        const double most = -std::expm1(-piece->depth.hi);
        const Interval alpha = Interval{-std::expm1(-piece->depth.lo), most}
                                   .widened(rounding.alpha + rounding.relative * most)
                                   .within(opacities);
        const auto blend = [&](const Interval& color, const Interval& behind) {
            const Interval result = over(alpha, color, behind);
            return result.widened(rounding.over + rounding.color + rounding.relative * result.hi);
        };
        for (std::size_t c = 0; c < 3; ++c) pixel[c] = blend(piece->color[c], pixel[c]);
        pixel[3] = blend({1, 1}, pixel[3]).within(opacities);
    }
    return pixel;
}

std::array<double, 4> composite_exactly(const std::vector<PieceBounds>& pieces) {
    // Front to back in sums of optical depth, faint pieces lose no digits.
    std::array<double, 4> pixel{};
    double depth = 0;
    for (const PieceBounds& piece : pieces) {
        const double share = std::exp(-depth) * -std::expm1(-piece.depth.lo);
        for (std::size_t c = 0; c < 3; ++c) pixel[c] += share * piece.color[c].lo;
        depth += piece.depth.lo;
    }
    pixel[3] = -std::expm1(-depth);
    return pixel;
}

}  // namespace lamina::selftest
