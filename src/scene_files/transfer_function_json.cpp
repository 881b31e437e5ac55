// SPDX-License-Identifier: Apache-2.0
#include "scene_files/transfer_function_json.h"

#include <algorithm>
#include <cmath>
#include <glm/vector_relational.hpp>
#include <optional>

#include "base/enum_words.h"
#include "optics/colormap.h"
#include "optics/given_points.h"
#include "optics/opacity.h"
#include "optics/opacity_slope.h"
#include "optics/shipped_colormaps.h"
#include "scene_files/color_json.h"

namespace lamina {
namespace {

// Differences of larger values are not finite (lamina/transfer_function.h).
constexpr double largest_value = 1e300;

enum class PointInterpolation { linear, extinction, nearest };

const char* name_of(PointInterpolation interpolation) {
    switch (interpolation) {
        case PointInterpolation::linear:
            return "linear";
        case PointInterpolation::extinction:
            return "extinction";
        case PointInterpolation::nearest:
            return "nearest";
    }
    return nullptr;
}

glm::dvec3 read_point_color(JsonReader& point, ImageColorSpace space) {
    const glm::dvec3 color = read_color(point, "color", glm::dvec3(1), space);
    if (glm::any(glm::lessThan(color, glm::dvec3(0))) ||
        glm::any(glm::greaterThan(color, glm::dvec3(1e30))))
        point.reject("color", "components from 0 to 1e30");
    return color;
}

void read_density(JsonReader& reader, GivenPoint& point) {
    if (reader.has("extinction") == reader.has("opacity")) {
        reader.fail_at("extinction", reader.has("opacity")
                                         ? "stands beside opacity, expected one of the two"
                                         : "is missing, expected extinction or opacity");
    }
    if (reader.has("extinction")) {
        point.density = reader.number("extinction");
        if (point.density < 0) reader.reject("extinction", "a number >= 0");
        point.smooth = reader.flag_or("smooth", false);
        return;
    }
    point.given_as = GivenPoint::Density::opacity;
    point.density = reader.number("opacity");
    if (point.density < 0 || point.density > 1) reader.reject("opacity", "a number from 0 to 1");
}

// Extinction that rises to opacity 1 in proportion rises to an arbitrary number, so the user is
// warned. Where opacity is linear on the way, nothing is arbitrary.
void warn_of_opaque_ramp(const std::vector<GivenPoint>& points, bool opacity_is_linear,
                         const JsonReader& reader, std::vector<std::string>* warnings) {
    if (warnings == nullptr) return;
    const auto by_opacity = [](const GivenPoint& point) {
        return point.given_as == GivenPoint::Density::opacity;
    };
    const auto opaque = [&](const GivenPoint& point) {
        return by_opacity(point) && point.density == 1;
    };
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        const GivenPoint &a = points[i], &b = points[i + 1];
        if (opaque(a) == opaque(b) || a.value == b.value) continue;
        if (opacity_is_linear && by_opacity(a) && by_opacity(b)) continue;
        warnings->push_back(fmt::format(
            "{}: transfer_function: extinction is linear from value {} to {} and runs to opacity "
            "1, taken as an optical depth of {:g} per unit_length",
            reader.file().string(), a.value, b.value,
            opacity_is_linear ? steepest_optical_depth : opaque_optical_depth));
        return;
    }
}

ValueRange read_range(JsonReader& reader) {
    const nlohmann::json& range = reader.value("colormap_range");
    if (!range.is_array() || range.size() != 2 || !range[0].is_number() || !range[1].is_number() ||
        !(range[0].get<double>() < range[1].get<double>()) ||
        range[0].get<double>() < -largest_value || range[1].get<double>() > largest_value) {
        reader.reject("colormap_range",
                      "two numbers [lo, hi] with lo < hi, between -1e300 and 1e300");
    }
    return {range[0].get<double>(), range[1].get<double>()};
}

// Data of one value have it in the middle of the map.
ValueRange widened(const ValueRange& range) {
    if (range.empty()) return {0, 1};
    if (range.lo < range.hi) return range;
    const double half = std::max(std::abs(range.lo), 1.0) / 2;
    return {range.lo - half, range.hi + half};
}

ValueRange range_of_data(const JsonReader& reader,
                         const TransferFunctionSurroundings& surroundings) {
    if (!surroundings.data_range)
        reader.fail_at("colormap_range", "is missing, expected [lo, hi]: there are no data here");
    const ValueRange range = widened(surroundings.data_range());
    if (range.lo < -largest_value || range.hi > largest_value) {
        reader.fail_at("colormap_range",
                       fmt::format("is missing, expected [lo, hi] between -1e300 and 1e300: the "
                                   "data go from {} to {}",
                                   range.lo, range.hi));
    }
    return range;
}

// Stretches the map's own range, which often is 0 to 1, to "colormap_range" or else the data's.
void stretch(Colormap& colormap, JsonReader& reader,
             const TransferFunctionSurroundings& surroundings) {
    const bool told = reader.has("colormap_range");
    if (!told && colormap.own_range) return;
    if (colormap.colors.front().value == colormap.colors.back().value)
        reader.fail_at("colormap_range", "cannot stretch a colour map that has a single value");
    const ValueRange range = told ? read_range(reader) : range_of_data(reader, surroundings);
    stretch(colormap, range.lo, range.hi);
}

// Stands for the name or the file of a colour map.
std::string colormap_source(JsonReader& reader) {
    const std::string text = reader.text("colormap");
    return is_colormap_name(text) ? text : reader.path_of("colormap").string();
}

// `space`: of the points' colours; none: they have none.
std::vector<GivenPoint> read_points(JsonReader& reader, std::optional<ImageColorSpace> space) {
    std::vector<GivenPoint> points;
    std::vector<JsonReader> elements = reader.objects("points");
    if (elements.size() > most_scene_points) {
        reader.fail_at("points", fmt::format("found {} points, expected at most {}",
                                             elements.size(), most_scene_points));
    }
    for (JsonReader& element : elements) {
        GivenPoint point;
        point.value = element.number("value");
        if (!points.empty() && point.value < points.back().value) {
            element.reject(
                "value",
                fmt::format("at least {}, the value before it (points go in order of value)",
                            points.back().value));
        }
        if (space) point.color = read_point_color(element, *space);
        read_density(element, point);
        points.push_back(point);
        element.close();
    }
    return points;
}

Colormap read_colormap(JsonReader& reader, ImageColorSpace space) {
    const std::string source = colormap_source(reader);
    try {
        return load_colormap(source, space);
    } catch (const Error& error) {
        std::error_code unknown;
        if (is_colormap_name(source) || std::filesystem::exists(source, unknown)) throw;
        reader.fail_at("colormap", error.what());
    }
}

// What the points of a transfer function are read and interpolated by.
struct PointRules {
    double unit_length = 1;
    PointInterpolation interpolation = PointInterpolation::linear;

    std::vector<TransferKnot> knots(const std::vector<GivenPoint>& points) const {
        return interpolation == PointInterpolation::linear
                   ? linear_in_opacity(points, unit_length)
                   : linear_in_extinction(points, unit_length);
    }
};

// Reads a map's colours, with the scene's points for extinction or with the map's own opacities.
TransferFunction read_with_colormap(JsonReader& reader, const PointRules& rules,
                                    const TransferFunctionSurroundings& surroundings) {
    if (rules.interpolation == PointInterpolation::nearest)
        reader.fail_at("interpolation", "nearest does not go with a colormap, expected linear");
    Colormap colormap = read_colormap(reader, surroundings.space);
    stretch(colormap, reader, surroundings);
    const bool own = !reader.has("points");
    const std::vector<GivenPoint> points = own ? given_points(colormap) : read_points(reader, {});
    if (points.empty()) {
        reader.reject("points", own ? "points with extinction or opacity: the colour map has no "
                                      "opacities of its own (Points)"
                                    : "at least one point");
    }
    try {
        std::vector<ExtinctionPoint> extinctions;
        for (const TransferKnot& knot : rules.knots(points))
            extinctions.push_back({knot.value, knot.optics.extinction, knot.smooth});
        return TransferFunction::linear(combine(colormap, extinctions));
    } catch (const Error& error) {
        reader.fail_at(own ? "colormap" : "points", error.what());
    }
}

TransferFunction read_colored(JsonReader& reader, const PointRules& rules,
                              const TransferFunctionSurroundings& surroundings) {
    const std::vector<GivenPoint> points = read_points(reader, surroundings.space);
    try {
        const std::vector<TransferKnot> plain = linear_in_extinction(points, rules.unit_length);
        if (rules.interpolation == PointInterpolation::nearest)
            return TransferFunction::nearest(plain);
        TransferFunction::linear(plain);  // checks the points as they were given
        warn_of_opaque_ramp(points, rules.interpolation == PointInterpolation::linear, reader,
                            surroundings.warnings);
        return TransferFunction::linear(rules.knots(points));
    } catch (const Error& error) {
        reader.fail_at("points", error.what());
    }
}

}  // namespace

std::filesystem::path colormap_file_of(JsonReader& transfer_function) {
    if (!transfer_function.has("colormap")) return {};
    const std::string source = colormap_source(transfer_function);
    return is_colormap_name(source) ? std::filesystem::path() : std::filesystem::path(source);
}

TransferFunction read_transfer_function(JsonReader reader,
                                        const TransferFunctionSurroundings& surroundings) {
    PointRules rules;
    rules.unit_length = reader.number_or("unit_length", 1);
    if (!(rules.unit_length > 0)) reader.reject("unit_length", "a number > 0");
    rules.interpolation =
        reader.choice<PointInterpolation>("interpolation", enum_words<PointInterpolation>());
    TransferFunction result = reader.has("colormap")
                                  ? read_with_colormap(reader, rules, surroundings)
                                  : read_colored(reader, rules, surroundings);
    reader.close();
    return result;
}

}  // namespace lamina
