// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "lamina/settings.h"

namespace lamina {

// Returns the direction of a vector of any length but 0.
glm::dvec3 unit_vector(const glm::dvec3& v);

// Lighting along one viewing ray (docs/numerics.md, section 10), in double precision.
class RayLights {
  public:
    // `lighting` must pass scene/scene.h's checks. `to_eye`: world direction, any length but 0.
    RayLights(const Lighting& lighting, const glm::dvec3& to_eye);

    // How light changes a colour c: the lit colour is c + weight * (c * change + highlight).
    struct Effect {
        double weight = 0;        // 0 if the gradient is 0, close to 1 if it is steep
        glm::dvec3 change{0};     // >= -1
        glm::dvec3 highlight{0};  // >= 0
        glm::dvec3 on(const glm::dvec3& c) const { return weight * (c * change + highlight); }
    };
    // `gradient`: in scalar units per world unit.
    Effect effect(const glm::dvec3& gradient) const;

    // Returns a bound on |Effect::on(c)| at weight 1, for colours c with components <= `brightest`.
    double largest_effect(double brightest) const;
    // Returns the span of what light can add to a component of colours up to 1.
    double effect_span() const;
    // Returns the largest factor by which light multiplies a component, highlights aside.
    double largest_factor() const;
    // Returns a bound on the components of lit colours whose own components are up to `brightest`.
    double brightest_lit(double brightest) const;

    double smallest_gradient() const { return smallest_gradient_; }
    // Returns the Effect's weight for a gradient of this length.
    double weight(double steepness) const;
    bool has_highlights() const { return specular_ > 0; }
    double power() const { return power_; }

    struct Direction {
        glm::dvec3 light{0};    // unit vector to the light
        glm::dvec3 halfway{0};  // between light and eye; 0 if they are opposite
        glm::dvec3 color{0};
    };
    std::span<const Direction> directions() const { return directions_; }

  private:
    double ambient_, diffuse_, specular_, power_, smallest_gradient_;
    double light_ = 0;  // largest component of the sum of all lights' colours
    std::vector<Direction> directions_;
};

}  // namespace lamina
