// SPDX-License-Identifier: Apache-2.0
#include "executors/lights.h"

#include <algorithm>
#include <glm/geometric.hpp>

#include "optics/ray_lights.h"

namespace lamina {
namespace {

// Largest most_turn: with it, a piece's gradient is nowhere shorter than .3 of that in the middle.
constexpr double most_growth = 0.7;
// Half the angle, in units of 1 / sqrt(power), by which the gradient may turn on a piece with
// highlights. A unit is the angle at which a highlight falls to exp(-1/2). If a piece turns by six
// units, one of the three nodes lies within 1.2 units of any peak.
constexpr double peak_widths = 3;

// Largest effect of light, as a multiple of most_bend, for which the turns of LightCuts are small
// enough. Stronger light needs smaller turns: the error of three nodes on smooth light falls with
// the sixth power (`order`) of the turn.
constexpr double usual_effect = 25, order = 6;

CpuLight::Direction direction_of(const Light& light, const std::array<glm::dvec3, 3>& axes) {
    CpuLight::Direction direction;
    direction.to_eye = !light.direction;
    for (std::size_t i = 0; i < 3; ++i) {
        direction.color[i] = static_cast<float>(light.color[static_cast<int>(i)]);
        if (light.direction) {
            const double along = glm::dot(unit_vector(*light.direction), unit_vector(axes[i]));
            direction.to_light[i] = static_cast<float>(along);
        }
    }
    direction.largest_color = *std::ranges::max_element(direction.color);
    return direction;
}

}  // namespace

LightCuts light_cuts(const Lighting& lighting) {
    LightCuts cuts;
    cuts.most_turn = cuts.most_plain_turn = most_growth;
    if (lighting.specular > 0)
        cuts.most_turn = std::min(most_growth, peak_widths / std::sqrt(lighting.power));
    const glm::dvec3 anywhere(0, 0, 1);
    const RayLights lights(lighting, anywhere);
    cuts.plain_effect = lights.largest_effect(1) - lights.largest_effect(0);
    cuts.highlight_effect = lights.largest_effect(0);
    return cuts;
}

CpuLight make_tile_light(const Lighting& lighting, const std::array<glm::dvec3, 3>& axes,
                         double most_bend, double faint_share) {
    CpuLight light;
    light.smallest = smallest_gradient_of(lighting);
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
    for (std::size_t axis = 0; axis < 3; ++axis)
        light.spacing[axis] = static_cast<float>(glm::length(axes[axis]));
    light.most_bend = static_cast<float>(most_bend);
    const LightCuts cuts = light_cuts(lighting);
    const double largest = cuts.largest_effect(), excess = largest / (usual_effect * most_bend);
    const double nearer = std::pow(std::max(excess, 1.0), -1 / order);
    light.most_turn = static_cast<float>(nearer * cuts.most_turn);
    light.most_plain_turn = static_cast<float>(nearer * cuts.most_plain_turn);
    light.highlight_effect = static_cast<float>(cuts.highlight_effect);
    light.plain_effect = static_cast<float>(cuts.plain_effect);
    light.faint_bend = static_cast<float>(faint_share * most_bend / std::max(largest, 1.0));
    return light;
}

}  // namespace lamina
