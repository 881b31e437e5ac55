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

// Reads the number at the front of a text, and removes it. Nothing if there is none or it is beyond
// `largest`.
std::optional<double> take_number(std::string_view& text, double largest) {
    double number = 0;
    const auto [stop, problem] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (problem != std::errc{} || !(std::abs(number) <= largest)) return std::nullopt;
    text.remove_prefix(static_cast<std::size_t>(stop - text.data()));
    return number;
}

// Returns the curve of "0,.2,.9" or "10:0,20:.5".
std::optional<OpacityCurve> curve_of_numbers(std::string_view text) {
    OpacityCurve curve{OpacityCurve::Form::points};
    const bool pairs = text.find(':') != text.npos;
    for (bool more = true; more; text.remove_prefix(more ? 1 : 0)) {
        OpacityCurve::Point point{static_cast<double>(curve.points.size()), 0};
        if (pairs) {
            const auto value = take_number(text, 1e300);
            if (!value || !text.starts_with(':')) return std::nullopt;
            text.remove_prefix(1);
            point.t = *value;
        }
        const auto share = take_number(text, 1);
        if (!share || *share < 0) return std::nullopt;
        point.share = *share;
        if (!curve.points.empty() && !(curve.points.back().t < point.t)) return std::nullopt;
        curve.points.push_back(point);
        more = text.starts_with(',');
    }
    const bool any = std::ranges::any_of(curve.points, [](const auto& p) { return p.share > 0; });
    if (!text.empty() || curve.points.size() < 2 || curve.points.size() > most_scene_points || !any)
        return std::nullopt;
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

std::optional<OpacityCurve> opacity_curve(const std::string& word) {
    using Form = OpacityCurve::Form;
    if (word == "linear") return OpacityCurve{Form::linear};
    if (word == "linear_r") return OpacityCurve{Form::linear, true};
    if (word == "geom") return OpacityCurve{Form::geom};
    if (word == "geom_r") return OpacityCurve{Form::geom, true};
    if (word == "foreground") return OpacityCurve{Form::foreground};
    if (word == "sigmoid") return OpacityCurve{Form::sigmoid};
    const std::string beginning = "sigmoid_";
    if (!word.starts_with(beginning)) return curve_of_numbers(word);
    OpacityCurve curve{Form::sigmoid};
    const char* const end = word.data() + word.size();
    int steepness = 0;
    const auto [stop, problem] = std::from_chars(word.data() + beginning.size(), end, steepness);
    if (problem != std::errc{} || stop != end || steepness < 1 || steepness > 20)
        return std::nullopt;
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
