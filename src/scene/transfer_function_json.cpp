// SPDX-License-Identifier: Apache-2.0
#include "scene/transfer_function_json.h"

#include <glm/vector_relational.hpp>

#include "optics/opacity.h"

namespace lamina {
namespace {

enum class Interpolation { linear, nearest };

glm::dvec3 read_color(JsonReader& point) {
    const glm::dvec3 color = point.vector_or("color", glm::dvec3(1));
    if (glm::any(glm::lessThan(color, glm::dvec3(0)))) point.reject("color", "components >= 0");
    return color;
}

double read_extinction(JsonReader& point, double unit_length, bool& opaque) {
    if (point.has("extinction") == point.has("opacity")) {
        point.fail_at("extinction", point.has("opacity") ? "stands beside opacity, expected one of the two"
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

// Interpolating towards opacity 1 means towards an arbitrary large extinction: the user should know.
void warn_of_opaque_ramp(const std::vector<TransferKnot>& points, const std::vector<bool>& opaque,
                         const JsonReader& reader, std::vector<std::string>* warnings) {
    if (warnings == nullptr) return;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        if (opaque[i] == opaque[i + 1] || points[i].value == points[i + 1].value) continue;
        warnings->push_back(fmt::format(
            "{}: transfer_function: linear interpolation from value {} to {} runs to opacity 1, taken as an optical "
            "depth of {:g} per unit_length",
            reader.file().string(), points[i].value, points[i + 1].value, opaque_optical_depth));
        return;
    }
}

}  // namespace

TransferFunction read_transfer_function(JsonReader reader, std::vector<std::string>* warnings) {
    const double unit_length = reader.number_or("unit_length", 1);
    if (!(unit_length > 0)) reader.reject("unit_length", "a number > 0");
    const auto interpolation = reader.choice<Interpolation>(
        "interpolation", {{"linear", Interpolation::linear}, {"nearest", Interpolation::nearest}});

    std::vector<TransferKnot> points;
    std::vector<bool> opaque;
    for (JsonReader& point : reader.objects("points")) {
        bool is_opaque = false;
        const double value = point.number("value");
        if (!points.empty() && value < points.back().value) {
            point.reject("value", fmt::format("at least {}, the value before it (points go in order of value)",
                                              points.back().value));
        }
        points.push_back({value, {read_color(point), read_extinction(point, unit_length, is_opaque)}});
        opaque.push_back(is_opaque);
        point.close();
    }
    reader.close();
    try {
        if (interpolation == Interpolation::nearest) return TransferFunction::nearest(points);
        warn_of_opaque_ramp(points, opaque, reader, warnings);
        return TransferFunction::linear(std::move(points));
    } catch (const KeyError&) {
        throw;
    } catch (const Error& error) {
        reader.fail_at("points", error.what());
    }
}

}  // namespace lamina
