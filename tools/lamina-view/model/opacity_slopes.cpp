// SPDX-License-Identifier: Apache-2.0
#include "model/opacity_slopes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>

namespace lamina::view {
namespace {
// Finds the slopes in the knots of a scene file, which replaces a slope by pieces of linear
// extinction (docs/scene.md, "Opacity"). with_slopes() tests, from each knot on:
// 1. A slope from or to opacity 1 has a step, and its dense side has the extinction 1e7 / length:
//    this gives the length, and the knots must be those that inside_slope() makes.
// 2. Otherwise all smooth knots that follow must be near the slope over unit_length or, if they
//    are not, over the length of best fit, rounded to as few digits as possible.
// Knots that are on no slope become points of linear extinction.

// Optical depths over the length: that of opacity 1, and the largest that pieces of a slope have.
constexpr double opaque_depth = 1e7, steepest_depth = 17;
// Largest relative distance of knots from a fitted slope. Pieces are within 7.8e-4 of their slope
// (docs/scene.md, "Opacity"); the fitted slope may be off by as much again.
constexpr double pieces_tolerance = 2 * 7.8e-4;

// Returns the extinction on a slope from a (`share` 0) to b (`share` 1).
double on_slope(const ExtinctionKnot& a, const ExtinctionKnot& b, double share, double length) {
    const double opacity =
        (1 - share) * opacity_of(a.extinction, length) + share * opacity_of(b.extinction, length);
    return extinction_of(opacity, length);
}

// Returns the largest relative distance in extinction of the knots `inside` from the slope.
double misfit(const ExtinctionKnot& a, std::span<const ExtinctionKnot> inside,
              const ExtinctionKnot& b, double length) {
    double worst = 0;
    for (const ExtinctionKnot& point : inside) {
        const double share = (point.value - a.value) / (b.value - a.value);
        const double wanted = on_slope(a, b, share, length);
        worst = std::max(worst, std::abs(point.extinction - wanted) / wanted);
    }
    return worst;
}

// Returns the length that fits best, by golden section over its logarithm. The longer the length,
// the more the extinction of the slope sags between its ends.
double best_length(const ExtinctionKnot& a, std::span<const ExtinctionKnot> inside,
                   const ExtinctionKnot& b) {
    constexpr double golden = .6180339887498949;
    const double densest = std::max(a.extinction, b.extinction);
    double from = std::log(1e-2 / densest), to = std::log(steepest_depth / densest);
    const auto at = [&](double log) { return misfit(a, inside, b, std::exp(log)); };
    double lower = to - golden * (to - from), upper = from + golden * (to - from);
    double at_lower = at(lower), at_upper = at(upper);
    while (to - from > 1e-6) {
        if (at_lower < at_upper) {
            to = upper;
            upper = lower;
            at_upper = at_lower;
            lower = to - golden * (to - from);
            at_lower = at(lower);
        } else {
            from = lower;
            lower = upper;
            at_lower = at_upper;
            upper = from + golden * (to - from);
            at_upper = at(upper);
        }
    }
    return std::exp((from + to) / 2);
}

// Returns the length for which the knots from a to b follow a slope, or 0 if there is none.
double length_of(const ExtinctionKnot& a, std::span<const ExtinctionKnot> inside,
                 const ExtinctionKnot& b, double unit_length) {
    if (a.extinction == b.extinction || !(a.value < b.value)) return 0;
    if (misfit(a, inside, b, unit_length) <= pieces_tolerance) return unit_length;
    // A length of few digits, which a person would have written, is preferred.
    const double best = best_length(a, inside, b);
    for (const int digits : {1, 2, 3}) {
        const double step = std::pow(10., std::floor(std::log10(best)) - digits + 1);
        const double round = std::round(best / step) * step;
        if (misfit(a, inside, b, round) <= pieces_tolerance) return round;
    }
    return misfit(a, inside, b, best) <= pieces_tolerance ? best : 0;
}

DensityPoint point_of(const ExtinctionKnot& knot, double length) {
    return {knot.value, knot.extinction, knot.smooth, length, {}};
}

// Returns true if the knots between a and b are those of a slope over `length`, up to rounding.
bool is_slope(std::span<const ExtinctionKnot> knots, std::size_t a, std::size_t b, double length) {
    constexpr double near = 1e-9;
    const auto wanted = inside_slope(point_of(knots[a], length), point_of(knots[b], length));
    if (wanted.size() != b - a - 1) return false;
    const double width = knots[b].value - knots[a].value;
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        const ExtinctionKnot& found = knots[a + 1 + i];
        if (std::abs(found.value - wanted[i].value) > near * width ||
            std::abs(found.extinction - wanted[i].extinction) > near * wanted[i].extinction)
            return false;
    }
    return true;
}

struct FoundSlope {
    std::size_t end = 0;  // index of its last knot
    double length = 0;
};

// Finds a slope that begins at `first` and has opacity 1 at one end. A step leads to opacity 1, and
// the pieces beside the step are not smooth. The extinction of opacity 1 gives the length.
std::optional<FoundSlope> opaque_slope(std::span<const ExtinctionKnot> knots, std::size_t first) {
    const std::size_t count = knots.size();
    const auto steps = [&](std::size_t i) {
        return i + 1 < count && knots[i].value == knots[i + 1].value;
    };
    const auto try_end = [&](std::size_t end, double dense) -> std::optional<FoundSlope> {
        const double length = opaque_depth / dense;
        if (end >= count || !is_slope(knots, first, end, length)) return {};
        return FoundSlope{end, length};
    };
    if (steps(first) && knots[first].extinction > knots[first + 1].extinction) {
        std::size_t end = first + 3;
        while (end + 1 < count && knots[end].smooth) ++end;
        return try_end(end, knots[first].extinction);
    }
    std::size_t end = first + 1;
    while (end + 1 < count && knots[end].smooth) ++end;
    if (end == first + 1 || !steps(end + 1)) return {};
    return try_end(end + 2, knots[end + 2].extinction);
}

}  // namespace

double opacity_of(double extinction, double length) {
    return -std::expm1(-extinction * length);
}

double extinction_of(double opacity, double length) {
    return (opacity < 1 ? -std::log1p(-opacity) : opaque_depth) / length;
}

std::vector<ExtinctionKnot> inside_slope(const DensityPoint& a, const DensityPoint& b) {
    std::vector<ExtinctionKnot> inside;
    if (!(a.value < b.value)) return inside;
    const double length = a.opacity_length;
    const auto slope = TransferFunction::linear_opacity(
        {{a.value, glm::dvec3(1), opacity_of(a.extinction, length)},
         {b.value, glm::dvec3(1), opacity_of(b.extinction, length)}},
        length);
    // The pieces of a slope end at the steepest depth; a step leads to an end that is denser.
    constexpr double rounding = 1 + 1e-12;
    const auto denser = [&](double extinction) {
        return extinction * length > steepest_depth * rounding;
    };
    for (const TransferKnot& knot : slope.knots()) {
        const double extinction = knot.optics.extinction;
        const bool at_a = knot.value == a.value, at_b = knot.value == b.value;
        const bool is_end = (at_a && !denser(a.extinction)) || (at_b && !denser(b.extinction)) ||
                            ((at_a || at_b) && denser(extinction));
        if (!is_end) inside.push_back({knot.value, extinction, knot.smooth});
    }
    return inside;
}

std::vector<DensityPoint> with_slopes(const std::vector<ExtinctionKnot>& knots,
                                      double unit_length) {
    std::vector<DensityPoint> points;
    for (std::size_t first = 0; first < knots.size(); ++first) {
        const ExtinctionKnot& knot = knots[first];
        points.push_back(point_of(knot, 0));
        if (const auto slope = opaque_slope(knots, first)) {
            points.back().opacity_length = slope->length;
            points.back().inside.assign(knots.begin() + static_cast<std::ptrdiff_t>(first + 1),
                                        knots.begin() + static_cast<std::ptrdiff_t>(slope->end));
            first = slope->end - 1;
            continue;
        }
        std::size_t last = first + 1;
        while (last + 1 < knots.size() && knots[last].smooth) ++last;
        if (last >= knots.size() || last == first + 1) continue;
        const std::span inside(knots.data() + first + 1, last - first - 1);
        const double length = length_of(knot, inside, knots[last], unit_length);
        if (length == 0) continue;
        points.back().opacity_length = length;
        points.back().inside.assign(inside.begin(), inside.end());
        first = last - 1;
    }
    return points;
}

}  // namespace lamina::view
