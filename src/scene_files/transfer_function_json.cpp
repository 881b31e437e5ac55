// SPDX-License-Identifier: Apache-2.0
#include "scene_files/transfer_function_json.h"

#include <algorithm>
#include <glm/vector_relational.hpp>

#include "base/enum_words.h"
#include "optics/colormap.h"
#include "optics/opacity.h"

namespace lamina {
namespace {

constexpr std::size_t max_points = 4096;

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

glm::dvec3 read_color(JsonReader& point) {
    const glm::dvec3 color = point.vector_or("color", glm::dvec3(1));
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

// Stretches the preset's own range, which often is 0 to 1, to "colormap_range".
void stretch(Colormap& colormap, JsonReader& reader) {
    if (!reader.has("colormap_range")) return;
    const nlohmann::json& range = reader.value("colormap_range");
    // Differences of larger values are not finite (lamina/transfer_function.h).
    constexpr double most = 1e300;
    if (!range.is_array() || range.size() != 2 || !range[0].is_number() || !range[1].is_number() ||
        !(range[0].get<double>() < range[1].get<double>()) || range[0].get<double>() < -most ||
        range[1].get<double>() > most) {
        reader.reject("colormap_range",
                      "two numbers [lo, hi] with lo < hi, between -1e300 and 1e300");
    }
    const double lo = range[0].get<double>(), hi = range[1].get<double>();
    const double from = colormap.colors.front().value, to = colormap.colors.back().value;
    if (from == to)
        reader.fail_at("colormap_range", "cannot stretch a colour map that has a single value");
    const auto stretched = [&](double value) {
        return lo + (hi - lo) * ((value - from) / (to - from));
    };
    for (ColorPoint& point : colormap.colors) point.value = stretched(point.value);
    for (OpacityPoint& point : colormap.opacities) point.value = stretched(point.value);
}

struct Points {
    std::vector<TransferKnot> knots;
    std::vector<bool> opaque;  // given as opacity 1
};

Points read_points(JsonReader& reader, double unit_length, bool colored) {
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
        if (colored) knot.optics.color = read_color(element);
        knot.optics.extinction = read_extinction(element, unit_length, opaque);
        points.knots.push_back(knot);
        points.opaque.push_back(opaque);
        element.close();
    }
    return points;
}

// Reads a preset's colours, with the scene's points for extinction or with the preset's own
// opacities.
TransferFunction read_with_colormap(JsonReader& reader, double unit_length) {
    Colormap colormap = read_paraview_colormap(reader.path_of("colormap"));
    stretch(colormap, reader);
    if (!reader.has("points")) return TransferFunction::linear(combine(colormap, unit_length));
    std::vector<ExtinctionPoint> extinctions;
    for (const TransferKnot& knot : read_points(reader, unit_length, false).knots) {
        extinctions.push_back({knot.value, knot.optics.extinction});
    }
    if (extinctions.empty()) reader.reject("points", "at least one point");
    return TransferFunction::linear(combine(colormap, extinctions));
}

}  // namespace

TransferFunction read_transfer_function(JsonReader reader, std::vector<std::string>* warnings) {
    const double unit_length = reader.number_or("unit_length", 1);
    if (!(unit_length > 0)) reader.reject("unit_length", "a number > 0");
    const auto interpolation =
        reader.choice<PointInterpolation>("interpolation", enum_words<PointInterpolation>());
    if (reader.has("colormap")) {
        if (interpolation == PointInterpolation::nearest) {
            reader.fail_at("interpolation", "nearest does not go with a colormap, expected linear");
        }
        TransferFunction result = read_with_colormap(reader, unit_length);
        reader.close();
        return result;
    }
    Points points = read_points(reader, unit_length, true);
    reader.close();
    try {
        if (interpolation == PointInterpolation::nearest)
            return TransferFunction::nearest(points.knots);
        warn_of_opaque_ramp(points.knots, points.opaque, reader, warnings);
        return TransferFunction::linear(std::move(points.knots));
    } catch (const Error& error) {
        reader.fail_at("points", error.what());
    }
}

}  // namespace lamina
