// SPDX-License-Identifier: Apache-2.0
#include "slicing/tile_light.h"

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
// That serves where light does so many times what it may bend, as usual light does at max_error 1.
// What a rule of three nodes misses of what is smooth falls with the sixth power of the turn.
constexpr double usual_effect = 25, order = 6;
// Of the largest bend, what may be left of parts that are faint: a ray has a few of them under
// light of strength 1, and the more the stronger it is.
constexpr double faint_share = 1.0 / 8;

TileLight::Direction direction_of(const Light& light, const Grid& grid) {
    TileLight::Direction direction;
    direction.to_eye = !light.direction;
    for (std::size_t i = 0; i < 3; ++i) {
        direction.color[i] = static_cast<float>(light.color[static_cast<int>(i)]);
        if (light.direction) {
            const double along = glm::dot(unit_vector(*light.direction), unit_vector(grid.step[i]));
            direction.to_light[i] = static_cast<float>(along);
        }
    }
    direction.largest_color = *std::ranges::max_element(direction.color);
    return direction;
}

}  // namespace

TileLight make_tile_light(const Lighting& lighting, const Grid& grid, double gradient_scale,
                          double most_bend) {
    TileLight light;
    light.gray = true;
    for (const Light& each : lighting.lights) {
        light.directions.push_back(direction_of(each, grid));
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
        light.spacing[axis] = static_cast<float>(glm::length(grid.step[axis]));
    light.most_bend = static_cast<float>(most_bend);
    const double largest = RayLights(lighting, glm::dvec3(0, 0, 1)).largest_effect(1);
    light.largest_effect = static_cast<float>(largest);
    light.faint_bend = static_cast<float>(faint_share * most_bend / std::max(largest, 1.0));
    light.most_turn = static_cast<float>(most_growth);
    if (lighting.specular > 0) {
        light.most_turn =
            static_cast<float>(std::min(most_growth, peak_widths / std::sqrt(lighting.power)));
    }
    const double excess = largest / (usual_effect * most_bend);
    if (excess > 1) light.most_turn *= static_cast<float>(std::pow(excess, -1 / order));
    return light;
}

}  // namespace lamina
