// SPDX-License-Identifier: Apache-2.0
#include "executors/gl_lights.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "executors/light_cuts.h"
#include "optics/ray_lights.h"

namespace lamina {
namespace {

bool is_gray(const Light& light) {
    return light.color.x == light.color.y && light.color.x == light.color.z;
}

glm::vec4 direction_of(const Light& light, const std::array<glm::dvec3, 3>& axes) {
    if (!light.direction) return {0, 0, 0, 1};
    const glm::dvec3 to_light = unit_vector(*light.direction);
    glm::dvec3 along(0);
    for (int axis = 0; axis < 3; ++axis)
        along[axis] = glm::dot(to_light, unit_vector(axes[static_cast<std::size_t>(axis)]));
    return {glm::vec3(along), 0};
}

}  // namespace

void set_light_defines(const Lighting& lighting, gl::Defines& defines) {
    defines.set("LIGHTS", static_cast<int>(lighting.lights.size()));
    if (std::ranges::all_of(lighting.lights, is_gray)) defines.set("GRAY_LIGHT", 1);
    if (lighting.specular > 0) defines.set("HIGHLIGHTS", 1);
}

void set_lights(const Lighting& lighting, const std::array<glm::dvec3, 3>& axes,
                gl::Program& program) {
    std::vector<glm::vec4> directions, colors;
    for (const Light& light : lighting.lights) {
        directions.push_back(direction_of(light, axes));
        colors.emplace_back(glm::vec3(light.color), 0);
    }
    program.set("light_terms",
                glm::vec3(glm::dvec3(lighting.ambient - 1, lighting.diffuse, lighting.specular)));
    program.set("half_power", static_cast<float>(lighting.power / 2));
    program.set("light_directions", std::span<const glm::vec4>(directions));
    program.set("light_colors", std::span<const glm::vec4>(colors));
}

void set_light_cuts(const Lighting& lighting, gl::Program& program) {
    const LightCuts cuts = light_cuts(lighting);
    program.set("hidden_limits",
                glm::vec4(cuts.highlight_effect, cuts.most_turn * cuts.most_turn, cuts.plain_effect,
                          cuts.most_plain_turn * cuts.most_plain_turn));
}

}  // namespace lamina
