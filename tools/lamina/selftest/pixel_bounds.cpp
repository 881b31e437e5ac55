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

OpticsRange point(const OpticalProperties& optics) {
    OpticsRange range;
    range.extinction = {optics.extinction, optics.extinction};
    for (int c = 0; c < 3; ++c)
        range.color[static_cast<std::size_t>(c)] = {optics.color[c], optics.color[c]};
    return range;
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
    // Summing optical depths from front to back keeps all digits of faint pieces.
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

void OpticsRange::include(const OpticsRange& other) {
    extinction.include(other.extinction);
    for (std::size_t c = 0; c < 3; ++c) color[c].include(other.color[c]);
}

OpticsRange optics_range(const TransferFunction& transfer_function, const Interval& scalars) {
    // Optics are linear between knots, so the extremes lie at the ends and at the knots between.
    OpticsRange range = point(transfer_function.at(scalars.lo));
    range.include(point(transfer_function.at(scalars.hi)));
    for (const TransferKnot& knot : transfer_function.knots()) {
        if (knot.value >= scalars.lo && knot.value <= scalars.hi) range.include(point(knot.optics));
    }
    return range;
}

}  // namespace lamina::selftest
