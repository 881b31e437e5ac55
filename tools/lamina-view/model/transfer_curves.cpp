// SPDX-License-Identifier: Apache-2.0
#include "model/transfer_curves.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <glm/common.hpp>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "lamina/error.h"
#include "model/opacity_slopes.h"

namespace lamina::view {
namespace {

DensityPoint at_value(double value, double extinction) {
    return {value, extinction, false, 0, {}};
}

// Interpolate by the same formulas as lamina's colour maps, so that their points can be told apart
// from interpolated ones.
double mix_numbers(double a, double b, double share) {
    return a * (1 - share) + b * share;
}
glm::dvec3 mix_numbers(const glm::dvec3& a, const glm::dvec3& b, double share) {
    return glm::mix(a, b, share);
}

template <typename Number>
Number between(double from, const Number& a, double to, const Number& b, double value) {
    return mix_numbers(a, b, (value - from) / (to - from));
}

// Returns the limits of a piecewise linear curve from below and from above.
template <typename Point, typename Number>
std::pair<Number, Number> sides(const std::vector<Point>& points, double value,
                                Number Point::*number) {
    const auto not_below = std::ranges::lower_bound(points, value, {}, &Point::value);
    const auto above = std::ranges::upper_bound(points, value, {}, &Point::value);
    if (not_below != above) return {(*not_below).*number, (*(above - 1)).*number};
    if (above == points.begin()) return {points.front().*number, points.front().*number};
    if (above == points.end()) return {points.back().*number, points.back().*number};
    const Point &a = *(above - 1), &b = *above;
    const Number there = between(a.value, a.*number, b.value, b.*number, value);
    return {there, there};
}

// The one or two knots at one value. If there is one, `below` and `above` are equal.
struct Site {
    TransferKnot below, above;
};

std::vector<Site> sites_of(const TransferFunction& function) {
    std::vector<Site> sites;
    for (const TransferKnot& knot : function.knots()) {
        if (!sites.empty() && sites.back().below.value == knot.value)
            sites.back().above = knot;
        else
            sites.push_back({knot, knot});
    }
    return sites;
}

bool near(double found, double wanted) {
    return std::abs(found - wanted) <=
           32 * std::numeric_limits<double>::epsilon() * std::abs(wanted);
}
bool near(const glm::dvec3& found, const glm::dvec3& wanted) {
    return near(found.x, wanted.x) && near(found.y, wanted.y) && near(found.z, wanted.z);
}

// Marks the sites that a curve needs: from each one the line to the farthest possible next one, on
// which all sites between lie, bit for bit if `exact`, else up to rounding. `get` reads the curve's
// number from a knot; may_go(site) returns true if a site may be left out.
template <typename Get, typename MayGo>
std::vector<char> needed_sites(const std::vector<Site>& sites, bool exact, const Get& get,
                               const MayGo& may_go) {
    std::vector<char> needed(sites.size(), 1);
    const auto line_goes = [&](std::size_t a, std::size_t b, std::size_t at, bool exactly) {
        const auto there = between(sites[a].above.value, get(sites[a].above), sites[b].below.value,
                                   get(sites[b].below), sites[at].below.value);
        const auto wanted = get(sites[at].below);
        return exactly ? there == wanted : near(there, wanted);
    };
    for (std::size_t a = 0; a + 2 < sites.size();) {
        std::size_t best = a + 1;
        for (std::size_t b = a + 2; b < sites.size() && may_go(sites[b - 1]); ++b) {
            bool on_line = true, exactly = true;
            for (std::size_t at = a + 1; at < b && on_line; ++at) {
                on_line = line_goes(a, b, at, false);
                exactly = exactly && line_goes(a, b, at, true);
            }
            if (!on_line) break;
            if (exactly || !exact) best = b;
        }
        for (std::size_t at = a + 1; at < best; ++at) needed[at] = 0;
        a = best;
    }
    return needed;
}

// Leaves out sites at the ends that repeat their neighbour: a curve is constant outside its points.
template <typename Get, typename MayGo>
void drop_constant_ends(const std::vector<Site>& sites, std::vector<char>& needed, const Get& get,
                        const MayGo& may_go) {
    std::size_t first = 0, last = sites.size() - 1;
    while (first < last && may_go(sites[first]) &&
           get(sites[first].above) == get(sites[first + 1].below))
        needed[first++] = 0;
    needed[first] = 1;
    while (last > first && may_go(sites[last]) &&
           get(sites[last].below) == get(sites[last - 1].above))
        needed[last--] = 0;
    needed[last] = 1;
}

template <typename Get, typename MayGo>
std::vector<char> needed_of(const std::vector<Site>& sites, bool exact, const Get& get,
                            const MayGo& may_go) {
    std::vector<char> needed = needed_sites(sites, exact, get, may_go);
    drop_constant_ends(sites, needed, get, may_go);
    return needed;
}

glm::dvec3 color_in(const TransferKnot& knot) {
    return knot.optics.color;
}
double extinction_in(const TransferKnot& knot) {
    return knot.optics.extinction;
}

// Throws Error unless points are in order, with at most two at one value.
template <typename Point>
void check_order(const std::vector<Point>& points, const char* curve) {
    if (points.empty()) throw Error(std::string(curve) + ": found no point, expected one or more");
    for (std::size_t i = 1; i < points.size(); ++i) {
        const bool falls = points[i].value < points[i - 1].value;
        if (falls || (i > 1 && points[i].value == points[i - 2].value))
            throw Error(std::string(curve) + ": point " + std::to_string(i) +
                        (falls ? " is below the one before it" : " is the third at its value"));
    }
}

std::vector<double> values_of(const std::vector<ExtinctionKnot>& knots,
                              const std::vector<ColorPoint>& colors) {
    std::vector<double> values;
    for (const ExtinctionKnot& knot : knots) values.push_back(knot.value);
    for (const ColorPoint& point : colors) values.push_back(point.value);
    std::ranges::sort(values);
    values.erase(std::unique(values.begin(), values.end()), values.end());
    return values;
}

bool same(const ColorPoint& a, const ColorPoint& b) {
    return a.value == b.value && a.color == b.color;
}

// Returns the stops around a value at which there is no stop.
std::optional<std::pair<ColorPoint, ColorPoint>> stops_around(const std::vector<ColorPoint>& colors,
                                                              double value) {
    const auto above = std::ranges::upper_bound(colors, value, {}, &ColorPoint::value);
    if (above == colors.begin() || above == colors.end() || (above - 1)->value == value) return {};
    return std::pair(*(above - 1), *above);
}

ColorSides color_with_kept(const TransferCurves& curves, double value) {
    const auto kept = std::ranges::lower_bound(curves.kept, value, {}, &KeptColor::value);
    if (kept != curves.kept.end() && kept->value == value) {
        const auto stops = stops_around(curves.colors, value);
        if (stops && same(stops->first, kept->before) && same(stops->second, kept->after))
            return {kept->color, kept->color};
    }
    return color_at(curves.colors, value);
}

// Returns the colours at sites that differ from the interpolation between stops by rounding.
std::vector<KeptColor> colors_to_keep(const std::vector<Site>& sites,
                                      const std::vector<ColorPoint>& colors) {
    std::vector<KeptColor> kept;
    for (const Site& site : sites) {
        const double value = site.below.value;
        const auto stops = stops_around(colors, value);
        if (stops && color_at(colors, value).above != site.above.optics.color)
            kept.push_back({stops->first, stops->second, value, site.above.optics.color});
    }
    return kept;
}

}  // namespace

SymlogAxis::SymlogAxis(double lo, double hi, double linear) : lo_(lo), hi_(hi), linear_(linear) {
    assert(lo < hi && linear > 0);
    from_ = curve(lo);
    width_ = curve(hi) - from_;
}

double SymlogAxis::curve(double number) const {
    return std::copysign(std::log1p(std::abs(number) / linear_), number);
}

double SymlogAxis::place(double number) const {
    return (curve(number) - from_) / width_;
}

double SymlogAxis::number(double place) const {
    if (place == 0) return lo_;
    if (place == 1) return hi_;
    const double along = from_ + place * width_;
    return std::copysign(linear_ * std::expm1(std::abs(along)), along);
}

std::vector<double> SymlogAxis::ticks(int most) const {
    const double largest = std::max(std::abs(lo_), std::abs(hi_));
    const int last = static_cast<int>(std::floor(std::log10(largest)));
    // Powers of 10 below `linear` would crowd at 0.
    const int first = std::min(last, static_cast<int>(std::ceil(std::log10(linear_))));
    const int sides = lo_ < 0 && hi_ > 0 ? 2 : 1;
    const int on_a_side = std::max(1, (most - 1) / sides);
    const int step = (last - first) / on_a_side + 1;
    std::vector<double> found;
    for (int power = last; power >= first; power -= step) {
        for (const double number : {std::pow(10., power), -std::pow(10., power)})
            if (number >= lo_ && number <= hi_) found.push_back(number);
    }
    if (lo_ <= 0 && hi_ >= 0) found.push_back(0);
    std::ranges::sort(found);
    return found;
}

std::vector<DensityPoint> ramp_shape(double lo, double hi, double densest) {
    return {at_value(lo, 0), at_value(hi, densest)};
}

std::vector<DensityPoint> peak_shape(double lo, double hi, double at, double densest) {
    const double half = (hi - lo) / 40;
    const double middle = std::clamp(at, lo + half, hi - half);
    return {at_value(middle - half, 0), at_value(middle, densest), at_value(middle + half, 0)};
}

std::vector<DensityPoint> step_shape(double lo, double hi, double at, double densest) {
    const double edge = std::clamp(at, lo, hi);
    return {at_value(edge, 0), at_value(edge, densest)};
}

std::vector<ExtinctionKnot> knots_of(const std::vector<DensityPoint>& points) {
    std::vector<ExtinctionKnot> knots;
    bool ends_inside = false;
    for (const DensityPoint& point : points) {
        // A point denser than the slopes' ends on both sides has no width and is left out.
        const bool before = !knots.empty() && knots.back().value == point.value && ends_inside;
        const bool after = !point.inside.empty() && point.inside.front().value == point.value;
        if (!(before && after)) knots.push_back({point.value, point.extinction, point.smooth});
        knots.insert(knots.end(), point.inside.begin(), point.inside.end());
        ends_inside = !point.inside.empty();
    }
    return knots;
}

DensitySides density_at(const std::vector<ExtinctionKnot>& knots, double value) {
    const auto [below, above] = sides(knots, value, &ExtinctionKnot::extinction);
    DensitySides found{below, above};
    const auto [first, end] = std::ranges::equal_range(knots, value, {}, &ExtinctionKnot::value);
    if (first != end) {
        found.smooth_below = first->smooth;
        found.smooth_above = (end - 1)->smooth;
    }
    return found;
}

ColorSides color_at(const std::vector<ColorPoint>& points, double value) {
    const auto [below, above] = sides(points, value, &ColorPoint::color);
    return {below, above};
}

TransferCurves::TransferCurves() : density(1), colors(1) {
    colors.front().color = glm::dvec3(1);
}

bool TransferCurves::operator==(const TransferCurves& other) const {
    return density == other.density && palette == other.palette &&
           std::ranges::equal(colors, other.colors, same);
}

TransferFunction TransferCurves::function() const {
    const std::vector<ExtinctionKnot> extinctions = knots_of(density);
    check_order(extinctions, "extinction");
    check_order(colors, "colour");
    std::vector<TransferKnot> knots;
    for (const double value : values_of(extinctions, colors)) {
        const DensitySides density_here = density_at(extinctions, value);
        const ColorSides color_here = color_with_kept(*this, value);
        const TransferKnot below{
            value, {color_here.below, density_here.below}, density_here.smooth_below};
        const TransferKnot above{
            value, {color_here.above, density_here.above}, density_here.smooth_above};
        knots.push_back(below);
        if (!(above == below)) knots.push_back(above);
    }
    const TransferFunction made =
        palette ? TransferFunction::nearest(knots) : TransferFunction::linear(knots);
    if (made.knots().size() > most_points) {
        throw Error("transfer function: found " + std::to_string(made.knots().size()) +
                    " points, expected at most " + std::to_string(most_points));
    }
    return made;
}

TransferCurves curves_of(const TransferFunction& function, double unit_length) {
    const std::vector<Site> sites = sites_of(function);
    const std::vector<char> for_color = needed_of(sites, false, color_in, [](const Site& site) {
        return site.below.optics.color == site.above.optics.color;
    });
    const std::vector<char> for_density =
        needed_of(sites, true, extinction_in, [](const Site& site) {
            return site.below.optics.extinction == site.above.optics.extinction &&
                   !site.below.smooth && !site.above.smooth;
        });
    TransferCurves curves;
    std::vector<ExtinctionKnot> knots;
    curves.colors.clear();
    for (std::size_t i = 0; i < sites.size(); ++i) {
        const auto& [below, above] = sites[i];
        const double value = below.value;
        if (for_color[i]) {
            curves.colors.push_back({value, below.optics.color});
            if (below.optics.color != above.optics.color)
                curves.colors.push_back({value, above.optics.color});
        }
        // Every site must be a point of a curve, or function() would lack its knot.
        if (for_density[i] || !for_color[i]) {
            knots.push_back({value, below.optics.extinction, below.smooth});
            if (below.optics.extinction != above.optics.extinction || below.smooth != above.smooth)
                knots.push_back({value, above.optics.extinction, above.smooth});
        }
    }
    curves.kept = colors_to_keep(sites, curves.colors);
    curves.density = with_slopes(knots, unit_length);
    return curves;
}

}  // namespace lamina::view
