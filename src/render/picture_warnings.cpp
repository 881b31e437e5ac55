// SPDX-License-Identifier: Apache-2.0
#include "render/picture_warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <utility>
#include <vector>

#include "base/number_text.h"
#include "base/warning.h"
#include "scene/camera.h"

namespace lamina {
namespace {

// Half a code of 8 bits: no opacity below it shows.
constexpr float least_opacity = .5F / 255;
// What is stored as the last of the 256 codes of a PNG: 254.5 / 255, which sRGB has for so much
// light.
constexpr float full_display = 254.5F / 255, full_light = .9956F;

std::string name_of_scene(const Scene& scene) {
    return scene.file.empty() ? "picture" : scene.file.string();
}

std::string range_text(const ValueRange& range) {
    const double fineness = fineness_of(range.lo, range.hi);
    return number_text(range.lo, fineness, 6) + " to " + number_text(range.hi, fineness, 6);
}

// The values that the transfer function shows, from the first to the last, constant beyond its
// points.
std::string shown_values(const TransferFunction& transfer_function) {
    const auto knots = transfer_function.knots();
    std::size_t first = 0, last = knots.size();
    while (first < last && knots[first].optics.extinction == 0) ++first;
    while (last > first && knots[last - 1].optics.extinction == 0) --last;
    if (first == last) return "no values at all";
    const ValueRange shown{knots[first > 0 ? first - 1 : 0].value,
                           knots[std::min(last, knots.size() - 1)].value};
    const double fineness = fineness_of(shown.lo, shown.hi);
    const std::string from = number_text(shown.lo, fineness, 6);
    const std::string to = number_text(shown.hi, fineness, 6);
    if (first == 0) return last == knots.size() ? "all values" : "values up to " + to;
    return last == knots.size() ? "values above " + from : "values from " + from + " to " + to;
}

// On which side of the picture all corners lie, or null.
const char* side_beside(const View& view, const std::array<glm::dvec3, 8>& corners) {
    const double half_width = .5 * view.width * view.pixel;
    const double half_height = .5 * view.height * view.pixel;
    int left = 0, right = 0, above = 0, below = 0;
    for (const glm::dvec3& corner : corners) {
        const glm::dvec3 arm = corner - view.eye;
        const double depth =
            view.projection == Projection::perspective ? glm::dot(arm, view.forward) : 1;
        const double x = glm::dot(arm, view.right), y = glm::dot(arm, view.up);
        left += x < -half_width * depth;
        right += x > half_width * depth;
        below += y < -half_height * depth;
        above += y > half_height * depth;
    }
    const std::pair<int, const char*> sides[] = {
        {left, "left of"}, {right, "right of"}, {above, "above"}, {below, "below"}};
    for (const auto& [count, side] : sides) {
        if (count == 8) return side;
    }
    return nullptr;
}

std::string why_nothing_shows(const Scene& scene, const Field& field, float largest) {
    const ValueRange range = field.range();
    if (scene.transfer_function.transparent(range.lo, range.hi)) {
        return fmt::format("the transfer function shows {}, and the data have {}",
                           shown_values(scene.transfer_function), range_text(range));
    }
    const View view(scene.camera, scene.width, scene.height);
    const auto corners = field.corners();
    const bool behind = std::ranges::all_of(corners, [&](const glm::dvec3& corner) {
        return glm::dot(corner - view.eye, view.forward) <= 0;
    });
    if (behind) return "the camera looks away from the data, which lie behind the eye";
    if (const char* const side = side_beside(view, corners))
        return fmt::format("the camera looks past the data, which lie {} the picture", side);
    if (largest > 0) {
        return fmt::format(
            "the largest opacity is {:.2g}, for the extinction of at most {:.3g} per unit of "
            "length "
            "is small for these data",
            largest, scene.transfer_function.max_extinction(range.lo, range.hi));
    }
    return "no pixel's ray meets a value that the transfer function shows";
}

// Where the data lie beyond all values between which colours change.
void warn_of_colors(const Scene& scene, const ValueRange& range) {
    const auto knots = scene.transfer_function.knots();
    std::size_t first = 0, last = knots.size() - 1;
    const auto change = [&](std::size_t i) {
        return knots[i].optics.color != knots[i + 1].optics.color;
    };
    while (first < last && !change(first)) ++first;
    while (last > first && !change(last - 1)) --last;
    const ValueRange colors{knots[first].value, knots[last].value};
    if (first == last || range.lo == range.hi || (colors.hi > range.lo && colors.lo < range.hi))
        return;
    warn(
        fmt::format("{}: the transfer function's colours change from {}, and the data have {}: "
                    "they all get one colour",
                    name_of_scene(scene), range_text(colors), range_text(range)));
}

}  // namespace

void warn_of_picture(const Scene& scene, const Field& field, const Image& picture) {
    const float full = scene.color_space == ImageColorSpace::display ? full_display : full_light;
    float largest = 0;
    std::size_t shown = 0, saturated = 0;
    for (std::size_t i = 0; i < picture.rgba.size(); i += 4) {
        const float* const pixel = &picture.rgba[i];
        largest = std::max(largest, pixel[3]);
        if (pixel[3] < least_opacity) continue;
        ++shown;
        saturated += std::max({pixel[0], pixel[1], pixel[2]}) >= full ? 1U : 0U;
    }
    if (shown > 0) warn_of_colors(scene, field.range());
    if (shown == 0) {
        warn(fmt::format("{}: the picture shows nothing: {}", name_of_scene(scene),
                         why_nothing_shows(scene, field, largest)));
    } else if (2 * saturated > shown) {
        warn(
            fmt::format("{}: {:.0f} % of the pixels that show something are saturated: less "
                        "extinction or darker colours would show more of the data",
                        name_of_scene(scene),
                        100 * static_cast<double>(saturated) / static_cast<double>(shown)));
    }
}

}  // namespace lamina
