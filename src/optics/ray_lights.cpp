// SPDX-License-Identifier: Apache-2.0
#include "optics/ray_lights.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace lamina {
namespace {

double largest(const glm::dvec3& v) {
    return std::max({v.x, v.y, v.z});
}

// Length below which the sum of two unit vectors is rounding error: the vectors are opposite.
constexpr double opposite = 1e-12;

}  // namespace

glm::dvec3 unit_vector(const glm::dvec3& v) {
    return glm::normalize(v / largest(glm::abs(v)));
}

RayLights::RayLights(const Lighting& lighting, const glm::dvec3& to_eye)
    : ambient_(lighting.ambient),
      diffuse_(lighting.diffuse),
      specular_(lighting.specular),
      power_(lighting.power),
      smallest_gradient_(lighting.smallest_gradient.value_or(0)) {
    assert(smallest_gradient_ > 0);
    const glm::dvec3 eye = unit_vector(to_eye);
    glm::dvec3 sum(0);
    for (const Light& light : lighting.lights) {
        Direction& direction = directions_.emplace_back();
        direction.light = light.direction ? unit_vector(*light.direction) : eye;
        const glm::dvec3 halfway = direction.light + eye;
        if (glm::length(halfway) > opposite) direction.halfway = glm::normalize(halfway);
        direction.color = light.color;
        sum += light.color;
    }
    light_ = largest(sum);
}

RayLights::Effect RayLights::effect(const glm::dvec3& gradient) const {
    Effect effect;
    const double scale = largest(glm::abs(gradient));
    if (!(scale > 0)) return effect;
    const glm::dvec3 scaled = gradient / scale;
    const double length = glm::length(scaled);
    const glm::dvec3 normal = scaled / length;
    effect.weight = weight(scale * length);
    effect.change = glm::dvec3(ambient_ - 1);
    for (const Direction& direction : directions_) {
        const double cosine = std::abs(glm::dot(normal, direction.light));
        effect.change += diffuse_ * cosine * direction.color;
        if (specular_ > 0) {
            const double shine = std::pow(std::abs(glm::dot(normal, direction.halfway)), power_);
            effect.highlight += specular_ * shine * direction.color;
        }
    }
    return effect;
}

// The quotient of the lengths, unlike that of their squares, becomes neither 0 / 0 nor inf / inf.
double RayLights::weight(double steepness) const {
    const double ratio = smallest_gradient_ / steepness;
    return 1 / (1 + ratio * ratio);
}

double RayLights::largest_effect(double brightest) const {
    const double change =
        std::max(std::abs(ambient_ - 1), std::abs(ambient_ - 1 + diffuse_ * light_));
    return brightest * change + specular_ * light_;
}

double RayLights::effect_span() const {
    const double least = std::min(ambient_ - 1, 0.0);
    const double most = std::max(ambient_ - 1 + (diffuse_ + specular_) * light_, 0.0);
    return most - least;
}

double RayLights::largest_factor() const {
    return std::max(1.0, ambient_ + diffuse_ * light_);
}

double RayLights::brightest_lit(double brightest) const {
    return brightest * largest_factor() + specular_ * light_;
}

}  // namespace lamina
