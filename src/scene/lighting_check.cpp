// SPDX-License-Identifier: Apache-2.0
#include "scene/lighting_check.h"

#include <fmt/format.h>

#include <cmath>

#include "base/error.h"
#include "lamina/scene.h"

namespace lamina {
namespace {

std::string vector_text(const glm::dvec3& v) {
    return fmt::format("[{}, {}, {}]", v.x, v.y, v.z);
}

class Check {
  public:
    void number(const char* key, double found, double lo, double hi) {
        if (!(found >= lo && found <= hi))
            add(key, fmt::format("found {}, expected a number from {:g} to {:g}", found, lo, hi));
    }

    void light(std::size_t number, const Light& light) {
        const std::string path = fmt::format("lights.{}.", number);
        if (light.direction && !is_direction(*light.direction)) {
            add(path + "direction",
                fmt::format("found {}, expected \"headlight\" or a vector [x, y, z] that is not 0, "
                            "of coordinates up to 1e100",
                            vector_text(*light.direction)));
        }
        for (int c = 0; c < 3; ++c) {
            if (!(light.color[c] >= 0 && light.color[c] <= Lighting::largest_term)) {
                add(path + "color", fmt::format("found {}, expected components from 0 to {:g}",
                                                vector_text(light.color), Lighting::largest_term));
            }
        }
    }

    void add(const std::string& key, const std::string& message) {
        if (!first_) first_ = {key, message};
    }

    const std::optional<LightingMistake>& first() const { return first_; }

  private:
    static bool is_direction(const glm::dvec3& v) {
        for (int axis = 0; axis < 3; ++axis) {
            if (!(std::abs(v[axis]) <= largest_scene_coordinate)) return false;
        }
        return v != glm::dvec3(0);
    }

    std::optional<LightingMistake> first_;
};

}  // namespace

std::optional<LightingMistake> mistake_in(const Lighting& lighting) {
    Check check;
    check.number("ambient", lighting.ambient, 0, Lighting::largest_term);
    check.number("diffuse", lighting.diffuse, 0, Lighting::largest_term);
    check.number("specular", lighting.specular, 0, Lighting::largest_term);
    check.number("power", lighting.power, 1, Lighting::largest_power);
    if (lighting.smallest_gradient.is_given()) {
        check.number("smallest_gradient", *lighting.smallest_gradient, Lighting::least_gradient,
                     Lighting::largest_gradient);
    }
    const std::size_t lights = lighting.lights.size();
    if (lights < 1 || lights > Lighting::most_lights) {
        check.add("lights",
                  fmt::format("found {} lights, expected 1 to {}", lights, Lighting::most_lights));
    }
    for (std::size_t i = 0; i < lights; ++i) check.light(i, lighting.lights[i]);
    return check.first();
}

void check_lighting(const Scene& scene) {
    if (!scene.lighting) return;
    if (const auto mistake = mistake_in(*scene.lighting))
        fail("{}: lighting.{}: {}", scene.file.string(), mistake->key, mistake->message);
}

}  // namespace lamina
