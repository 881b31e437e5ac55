// SPDX-License-Identifier: Apache-2.0
#include "scene_files/transfer_function_json.h"

#include <algorithm>
#include <cmath>
#include <glm/vector_relational.hpp>
#include <optional>

#include "base/enum_words.h"
#include "optics/colormap.h"
#include "optics/opacity.h"
#include "optics/shipped_colormaps.h"
#include "scene_files/color_json.h"

namespace lamina {
namespace {

constexpr std::size_t max_points = 4096;
// Differences of larger values are not finite (lamina/transfer_function.h).
constexpr double largest_value = 1e300;

enum class PointInterpolation { linear, nearest };

const char* name_of(PointInterpolation interpolation) {
    switch (interpolation) {
        case PointInterpolation::linear:
            return "linear";
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

double read_extinction(JsonReader& point, double unit_length, bool& opaque) {
    if (point.has("extinction") == point.has("opacity")) {
        point.fail_at("extinction", point.has("opacity")
                                        ? "stands beside opacity, expected one of the two"
                                        : "is missing, expected extinction or opacity");
    }
    if (point.has("extinction")) {
        const double extinction = point.number("extinction");
        if (extinction < 0) point.reject("extinction", "a number >= 0");
        return extinction;
    }
    const double opacity = point.number("opacity");
    if (opacity < 0 || opacity > 1) point.reject("opacity", "a number from 0 to 1");
    opaque = opacity == 1;
    return extinction_from_opacity(opacity, unit_length);
}

// A ramp to opacity 1 interpolates to an arbitrarily large extinction, so the user is warned.
void warn_of_opaque_ramp(const std::vector<TransferKnot>& points, const std::vector<bool>& opaque,
                         const JsonReader& reader, std::vector<std::string>* warnings) {
    if (warnings == nullptr) return;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        if (opaque[i] == opaque[i + 1] || points[i].value == points[i + 1].value) continue;
        warnings->push_back(fmt::format(
            "{}: transfer_function: linear interpolation from value {} to {} runs to opacity 1, "
            "taken as an optical "
            "depth of {:g} per unit_length",
            reader.file().string(), points[i].value, points[i + 1].value, opaque_optical_depth));
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

struct Points {
    std::vector<TransferKnot> knots;
    std::vector<bool> opaque;  // given as opacity 1
};

// `space`: of the points' colours; none: they have none.
Points read_points(JsonReader& reader, double unit_length, std::optional<ImageColorSpace> space) {
    Points points;
    std::vector<JsonReader> elements = reader.objects("points");
    if (elements.size() > max_points) {
        reader.fail_at("points", fmt::format("found {} points, expected at most {}",
                                             elements.size(), max_points));
    }
    for (JsonReader& element : elements) {
        bool opaque = false;
        TransferKnot knot;
        knot.value = element.number("value");
        if (!points.knots.empty() && knot.value < points.knots.back().value) {
            element.reject(
                "value",
                fmt::format("at least {}, the value before it (points go in order of value)",
                            points.knots.back().value));
        }
        if (space) knot.optics.color = read_point_color(element, *space);
        knot.optics.extinction = read_extinction(element, unit_length, opaque);
        points.knots.push_back(knot);
        points.opaque.push_back(opaque);
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

// Reads a map's colours, with the scene's points for extinction or with the map's own opacities.
TransferFunction read_with_colormap(JsonReader& reader, double unit_length,
                                    const TransferFunctionSurroundings& surroundings) {
    Colormap colormap = read_colormap(reader, surroundings.space);
    stretch(colormap, reader, surroundings);
    if (!reader.has("points")) return TransferFunction::linear(combine(colormap, unit_length));
    std::vector<ExtinctionPoint> extinctions;
    for (const TransferKnot& knot : read_points(reader, unit_length, {}).knots) {
        extinctions.push_back({knot.value, knot.optics.extinction});
    }
    if (extinctions.empty()) reader.reject("points", "at least one point");
    return TransferFunction::linear(combine(colormap, extinctions));
}

}  // namespace

std::filesystem::path colormap_file_of(JsonReader& transfer_function) {
    if (!transfer_function.has("colormap")) return {};
    const std::string source = colormap_source(transfer_function);
    return is_colormap_name(source) ? std::filesystem::path() : std::filesystem::path(source);
}

TransferFunction read_transfer_function(JsonReader reader,
                                        const TransferFunctionSurroundings& surroundings) {
    const double unit_length = reader.number_or("unit_length", 1);
    if (!(unit_length > 0)) reader.reject("unit_length", "a number > 0");
    const auto interpolation =
        reader.choice<PointInterpolation>("interpolation", enum_words<PointInterpolation>());
    if (reader.has("colormap")) {
        if (interpolation == PointInterpolation::nearest) {
            reader.fail_at("interpolation", "nearest does not go with a colormap, expected linear");
        }
        TransferFunction result = read_with_colormap(reader, unit_length, surroundings);
        reader.close();
        return result;
    }
    Points points = read_points(reader, unit_length, surroundings.space);
    reader.close();
    try {
        if (interpolation == PointInterpolation::nearest)
            return TransferFunction::nearest(points.knots);
        warn_of_opaque_ramp(points.knots, points.opaque, reader, surroundings.warnings);
        return TransferFunction::linear(std::move(points.knots));
    } catch (const Error& error) {
        reader.fail_at("points", error.what());
    }
}

}  // namespace lamina
