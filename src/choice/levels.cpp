// SPDX-License-Identifier: Apache-2.0
#include "choice/levels.h"

#include <algorithm>
#include <cmath>

namespace lamina {

namespace {

// Least mean slope, in ranges of values over LevelLengths::range: extinctions stay finite.
constexpr double least_slope = 1;

double slope_at(double value, const Variation& variation, const LevelLengths& lengths) {
    const double least = least_slope * (variation.hi() - variation.lo()) / lengths.range;
    return std::max(variation.slope(variation.bin_of(value)), least);
}

}  // namespace

// A peak is a triangle: its integral over values is the extinction at its top times half_width. A
// ray crosses the values of the peak on a length of their width over the slope.
std::vector<TransferKnot> points_of_levels(const std::vector<Level>& levels, double end,
                                           const glm::dvec3& end_color, const Variation& variation,
                                           const LevelLengths& lengths) {
    std::vector<TransferKnot> points;
    const auto add = [&](double value, const glm::dvec3& color, double extinction) {
        if (points.empty() || value > points.back().value)
            points.push_back({value, {color, extinction}});
    };
    double inside = 0;  // extinction between two peaks
    for (std::size_t i = 0; i < levels.size(); ++i) {
        const Level& level = levels[i];
        const double depth = -std::log1p(-level.opacity);
        const double top = depth * slope_at(level.value, variation, lengths) / level.half_width;
        add(level.value - level.half_width, i > 0 ? levels[i - 1].color : level.color, inside);
        add(level.value, level.color, top);
        inside = std::min(depth / (2 * lengths.thickness), top);
        if (i + 1 < levels.size()) {
            add(level.value + level.half_width, level.color, inside);
        } else {
            add(end, end_color, top);
        }
    }
    return points;
}

}  // namespace lamina
