// SPDX-License-Identifier: Apache-2.0
#include "slicing/tile_light.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "optics/ray_lights.h"
#include "slicing/light_cuts.h"

namespace lamina {
namespace {

// Cuts of light (slicing/light_cuts.h) serve where light does so many times what it may bend, as
// usual light does at max_error 1. What a rule of three nodes misses of what is smooth falls with
// the sixth power of the turn.
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

TileLight make_tile_light(const Lighting& lighting, const Grid& grid, double most_bend) {
    TileLight light;
    light.smallest = smallest_gradient_of(lighting);
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
    for (std::size_t axis = 0; axis < 3; ++axis)
        light.spacing[axis] = static_cast<float>(glm::length(grid.step[axis]));
    light.most_bend = static_cast<float>(most_bend);
    const LightCuts cuts = light_cuts(lighting);
    light.most_turn = static_cast<float>(cuts.most_turn);
    light.largest_effect = static_cast<float>(cuts.largest_effect);
    const double largest = cuts.largest_effect, excess = largest / (usual_effect * most_bend);
    if (excess > 1) light.most_turn *= static_cast<float>(std::pow(excess, -1 / order));
    light.faint_bend = static_cast<float>(faint_share * most_bend / std::max(largest, 1.0));
    return light;
}

}  // namespace lamina
