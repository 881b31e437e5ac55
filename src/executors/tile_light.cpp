// SPDX-License-Identifier: Apache-2.0
#include "executors/tile_light.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "optics/ray_lights.h"

namespace lamina {
namespace {

// The gradient then is nowhere shorter than .3 of what it is in the middle.
constexpr double most_growth = 0.7;
// A highlight falls to exp(-1/2) at an angle of 1 / sqrt(power). Of six times that, a node of three
// lies within 1.2 times that of any peak.
constexpr double peak_widths = 3;

TileLight::Direction direction_of(const Light& light, const std::array<glm::dvec3, 3>& axes) {
    TileLight::Direction direction;
    direction.to_eye = !light.direction;
    for (std::size_t i = 0; i < 3; ++i) {
        direction.color[i] = static_cast<float>(light.color[static_cast<int>(i)]);
        if (light.direction) {
            const double along = glm::dot(unit_vector(*light.direction), unit_vector(axes[i]));
            direction.to_light[i] = static_cast<float>(along);
        }
    }
    return direction;
}

}  // namespace

TileLight make_tile_light(const Lighting& lighting, const std::array<glm::dvec3, 3>& axes,
                          double gradient_scale, double most_bend) {
    TileLight light;
    light.gray = true;
    for (const Light& each : lighting.lights) {
        light.directions.push_back(direction_of(each, axes));
        light.gray = light.gray && each.color.x == each.color.y && each.color.x == each.color.z;
    }
    light.ambient = static_cast<float>(lighting.ambient);
    light.diffuse = static_cast<float>(lighting.diffuse);
    light.specular = static_cast<float>(lighting.specular);
    light.half_power = static_cast<float>(lighting.power / 2);
    if (std::floor(lighting.power / 2) == lighting.power / 2)
        light.whole_half_power = static_cast<int>(lighting.power / 2);
    // Within what float32 can divide by: outside, all or nothing is lit.
    const double smallest = std::clamp(*lighting.smallest_gradient * gradient_scale, 1e-15, 1e15);
    light.smallest_square = static_cast<float>(smallest * smallest);
    for (std::size_t axis = 0; axis < 3; ++axis)
        light.spacing[axis] = static_cast<float>(glm::length(axes[axis]));
    light.most_bend = static_cast<float>(most_bend);
    light.most_turn = static_cast<float>(most_growth);
    if (lighting.specular > 0) {
        light.most_turn =
            static_cast<float>(std::min(most_growth, peak_widths / std::sqrt(lighting.power)));
    }
    light.largest_effect =
        static_cast<float>(RayLights(lighting, glm::dvec3(0, 0, 1)).largest_effect(1));
    return light;
}

}  // namespace lamina
