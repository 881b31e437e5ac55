// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <glm/vec3.hpp>

#include "lamina/lighting.h"
#include "selftest/layered_box.h"
#include "selftest/pixel_bounds.h"

namespace lamina::selftest {

// Light on a ray along which the gradient is the same everywhere, as in a box of one layer: the lit
// colour is a factor times the unlit one, and a highlight times opacity (docs/numerics.md, section
// 10). With ambient light 1 alone the factor is 1 in any box.
class OneGradientLight {
  public:
    OneGradientLight(const Lighting& lighting, const LayeredBox& box, const View::Ray& ray);

    void shine_on(std::array<double, 4>& pixel) const;
    // `error`: of factor and highlight, a share of all terms together.
    void shine_on(PixelBounds& pixel, double error) const;

  private:
    glm::dvec3 factor_{1}, highlight_{0};
    double terms_ = 0;
};

}  // namespace lamina::selftest
