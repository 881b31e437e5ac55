// SPDX-License-Identifier: Apache-2.0
#include "choice/opacity_presets.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>
#include <vector>

#include "base/enum_words.h"
#include "base/error.h"
#include "optics/colormap.h"

namespace lamina {
namespace {

// Opacities of 1 in a colour map count as this optical depth over a unit length: 1 - e^-17 rounds
// to 1 in float32.
constexpr double largest_depth = 17;

// Largest distance of the straight pieces from a curve, as a share of its largest extinction.
constexpr double curve_tolerance = 1e-3;
constexpr int most_halvings = 10;

// geom rises from 1e-6 to 255 codes of 8 bits, as in pyvista.
constexpr double geom_ratio = 255e6;

// Adds the points of a curve between two values of t, without the first, until straight pieces
// between them keep the tolerance at their quarters.
void add_points(const OpacityCurve& curve, double from, double to, int halvings,
                std::vector<double>& places) {
    const double at_from = curve.at(from), at_to = curve.at(to);
    const bool straight = std::ranges::all_of(std::to_array({.25, .5, .75}), [&](double share) {
        const double line = at_from + share * (at_to - at_from);
        return std::abs(curve.at(from + share * (to - from)) - line) <= curve_tolerance;
    });
    if (straight || halvings == 0) {
        places.push_back(to);
        return;
    }
    const double middle = from + (to - from) / 2;
    add_points(curve, from, middle, halvings - 1, places);
    add_points(curve, middle, to, halvings - 1, places);
}

// Returns the share at t of straight lines between points.
double share_between(const std::vector<OpacityCurve::Point>& points, double t) {
    const auto next = std::ranges::upper_bound(points, t, {}, &OpacityCurve::Point::t);
    if (next == points.begin()) return points.front().share;
    if (next == points.end()) return points.back().share;
    const OpacityCurve::Point &a = *(next - 1), &b = *next;
    return a.share + (t - a.t) / (b.t - a.t) * (b.share - a.share);
}

// Returns the number that all of a text is. Throws Error unless it lies between `least` and `most`.
double number_of(std::string_view text, double least, double most, const char* expected) {
    double number = 0;
    const char* const end = text.data() + text.size();
    const auto [stop, problem] = std::from_chars(text.data(), end, number);
    if (problem != std::errc{} || stop != end || !(number >= least && number <= most))
        fail("{}, found {}", expected, text.empty() ? "none" : shortened(std::string(text)));
    return number;
}

// Returns the point of "VALUE:NUMBER", or of "NUMBER" with the number `place` as its t.
OpacityCurve::Point point_of(std::string_view text, bool has_value, std::size_t place) {
    if (!has_value)
        return {static_cast<double>(place), number_of(text, 0, 1, "numbers from 0 to 1")};
    const std::size_t colon = text.find(':');
    if (colon == text.npos) {
        fail("a value before each number, as in 10:0,20:.5, found {} without one",
             text.empty() ? "a number" : shortened(std::string(text)));
    }
    return {number_of(text.substr(0, colon), -1e300, 1e300, "a value before each number"),
            number_of(text.substr(colon + 1), 0, 1, "numbers from 0 to 1 after the values")};
}

// Returns the curve of "0,.2,.9" or "10:0,20:.5". Throws Error that says what is expected.
OpacityCurve curve_of_numbers(std::string_view text) {
    OpacityCurve curve{OpacityCurve::Form::points};
    const bool pairs = text.find(':') != text.npos;
    for (bool more = true; more;) {
        const std::size_t comma = text.find(',');
        const auto point = point_of(text.substr(0, comma), pairs, curve.points.size());
        if (!curve.points.empty() && !(curve.points.back().t < point.t))
            fail("rising values, found {} after {}", point.t, curve.points.back().t);
        curve.points.push_back(point);
        more = comma != text.npos;
        text.remove_prefix(more ? comma + 1 : text.size());
    }
    if (curve.points.size() < 2) fail("two or more numbers, as in 0,.2,.9 or 10:0,20:.5");
    if (curve.points.size() > most_scene_points)
        fail("at most {} numbers, found {}", most_scene_points, curve.points.size());
    if (std::ranges::none_of(curve.points, [](const auto& point) { return point.share > 0; }))
        fail("a number above 0");
    const ValueRange range{curve.points.front().t, curve.points.back().t};
    for (OpacityCurve::Point& point : curve.points)
        point.t = (point.t - range.lo) / (range.hi - range.lo);
    curve.points.back().t = 1;
    if (pairs) curve.range = range;
    return curve;
}

// Returns the function's colours as a map at their values.
Colormap colors_of(const TransferFunction& transfer_function) {
    Colormap colors;
    for (const TransferKnot& knot : transfer_function.knots())
        colors.colors.push_back({knot.value, knot.optics.color});
    return colors;
}

}  // namespace

double OpacityCurve::at(double t) const {
    const double x = reversed ? 1 - t : t;
    switch (form) {
        case Form::linear:
            return x;
        case Form::geom:
            return std::pow(geom_ratio, x - 1);
        case Form::sigmoid:
            return 1 / (1 + std::exp(-steepness * (2 * x - 1)));
        case Form::points:
            return share_between(points, t);
        case Form::foreground:
        case Form::of_colormap:
            return 1;
    }
    unreachable_enum();
}

OpacityCurve opacity_curve(const std::string& word) {
    using Form = OpacityCurve::Form;
    if (word == "linear") return {Form::linear};
    if (word == "linear_r") return {Form::linear, true};
    if (word == "geom") return {Form::geom};
    if (word == "geom_r") return {Form::geom, true};
    if (word == "foreground") return {Form::foreground};
    if (word == "sigmoid") return {Form::sigmoid};
    if (word.find_first_of("0123456789.+-,:") == 0) return curve_of_numbers(word);
    const std::string beginning = "sigmoid_";
    if (!word.starts_with(beginning)) {
        fail(
            "linear, linear_r, geom, geom_r, sigmoid, sigmoid_1 to sigmoid_20, foreground, or "
            "numbers as in 0,.2,.9 or 10:0,20:.5");
    }
    OpacityCurve curve{Form::sigmoid};
    const char* const end = word.data() + word.size();
    int steepness = 0;
    const auto [stop, problem] = std::from_chars(word.data() + beginning.size(), end, steepness);
    if (problem != std::errc{} || stop != end || steepness < 1 || steepness > 20)
        fail("sigmoid_1 to sigmoid_20");
    curve.steepness = steepness;
    return curve;
}

ValueRange shown_range(const TransferFunction& transfer_function) {
    const auto knots = transfer_function.knots();
    ValueRange all{knots.front().value, knots.back().value};
    const auto shows = [](const TransferKnot& knot) { return knot.optics.extinction > 0; };
    const auto first = std::ranges::find_if(knots, shows);
    if (first == knots.end()) return all;
    auto last = knots.end() - 1;
    while (!shows(*last)) --last;
    return {first == knots.begin() ? all.lo : (first - 1)->value,
            last + 1 == knots.end() ? all.hi : (last + 1)->value};
}

TransferFunction with_opacity(const TransferFunction& transfer_function, const OpacityCurve& curve,
                              const ValueRange& range) {
    const auto knots = transfer_function.knots();
    std::vector<double> places;
    if (curve.form == OpacityCurve::Form::points) {
        for (const OpacityCurve::Point& point : curve.points) places.push_back(point.t);
    } else {
        places = {0};
        add_points(curve, 0, 1, most_halvings, places);
    }
    std::vector<ExtinctionPoint> points;
    if (curve.at(0) > 0 && !curve.range) points.push_back({range.lo, 0});
    for (const double t : places) {
        const double value = t == 1 ? range.hi : range.lo + t * (range.hi - range.lo);
        points.push_back({value, curve.at(t)});
    }
    const bool ends =
        !curve.range && knots.back().optics.extinction == 0 && knots.back().value <= range.hi;
    if (ends && curve.at(1) > 0) points.push_back({range.hi, 0});
    return TransferFunction::linear(combine(colors_of(transfer_function), points));
}

TransferFunction with_opacity_of(const TransferFunction& transfer_function,
                                 const Colormap& colormap) {
    if (colormap.opacities.empty())
        fail("the colour map has no opacities of its own, expected some for this preset");
    std::vector<ExtinctionPoint> points;
    for (const OpacityPoint& point : colormap.opacities)
        points.push_back({point.value, std::min(-std::log1p(-point.opacity), largest_depth)});
    return TransferFunction::linear(combine(colors_of(transfer_function), points));
}

std::span<const Preset> presets() {
    static constexpr Preset all[] = {
        {"ct-bone", "ct-bone", "colormap", "two"},
        {"ct-soft-tissue", "ct-soft-tissue", "colormap", "headlight"},
        {"ct-lung", "ct-lung", "colormap", "headlight"},
        {"ct-angio", "ct-angio", "colormap", "two"},
        {"mr", "greys", "sigmoid_5", "headlight"},
        {"microscopy", "inferno", "linear", ""},
    };
    return all;
}

std::optional<std::string> mistake_in_hounsfield_units(const ValueRange& range,
                                                       const Colormap& colormap,
                                                       const std::string& name) {
    const std::string found = fmt::format("found values from {:.6g} to {:.6g}, expected HU for {}",
                                          range.lo, range.hi, name);
    const std::string hint = fmt::format(
        "a range LO,HI (--range; in Python clim; in a scene colormap_range) says which values "
        "stand for {:.6g} and {:.6g} HU (0,4095 for HU + 1024)",
        colormap.colors.front().value, colormap.colors.back().value);
    if (range.lo >= 0) {
        return fmt::format("{}: none is below 0, but air is -1000 HU and fat -100; {}", found,
                           hint);
    }
    ValueRange shows;
    for (const OpacityPoint& point : colormap.opacities) {
        if (point.opacity > 0)
            shows = shows.empty() ? ValueRange{point.value, point.value}
                                  : ValueRange{std::min(shows.lo, point.value),
                                               std::max(shows.hi, point.value)};
    }
    if (shows.empty() || (range.hi >= shows.lo && range.lo <= shows.hi)) return std::nullopt;
    return fmt::format("{}, which shows {:.6g} to {:.6g} HU; {}", found, shows.lo, shows.hi, hint);
}

}  // namespace lamina
