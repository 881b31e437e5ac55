// SPDX-License-Identifier: Apache-2.0
// Rays through a layered box, cut into pieces: exactly, and as each way to draw cuts them. Bounds
// say what a way to draw may make of a piece.
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <vector>

#include "lamina/settings.h"
#include "lamina/transfer_function.h"
#include "selftest/layered_box.h"
#include "selftest/pixel_bounds.h"

namespace lamina::selftest {

// The exact pieces, one for each layer, in closed form (docs/numerics.md, section 5). Empty if
// the ray misses the box.
std::vector<PieceBounds> exact_pieces(const LayeredBox& box,
                                      const TransferFunction& transfer_function,
                                      const View::Ray& ray);

// N slabs of equal thickness perpendicular to the view direction, from the box's nearest to its
// farthest point in front of the eye (docs/scene.md, render.slice.samples).
struct Slabs {
    double near = 0, thickness = 0;  // eye-space depths
    int count = 0;
};
Slabs slabs_of(const LayeredBox& box, const View& view, int count);

// Pieces of classification `post`: the piece of the ray in a slab has the optics of the scalar in
// its middle.
std::vector<PieceBounds> middle_pieces(const LayeredBox& box,
                                       const TransferFunction& transfer_function,
                                       const View::Ray& ray, const Slabs& slabs,
                                       const Precision& precision);

// Pieces of classification `preintegrated`. If the scalar is linear in a slab, the piece of the ray
// there has the exact optical depth. Otherwise it has an optical depth of scalars that occur in the
// piece. Its colours occur in the piece.
std::vector<PieceBounds> run_pieces(const LayeredBox& box,
                                    const TransferFunction& transfer_function, const View::Ray& ray,
                                    const Slabs& slabs, const Precision& precision);

// The exact pieces as shown by tetrahedra that conform to the layers. The errors of faces add up to
// `length_error` (world units) along the ray.
std::vector<PieceBounds> tet_pieces(const LayeredBox& box,
                                    const TransferFunction& transfer_function, const View::Ray& ray,
                                    double length_error, const Precision& precision);

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
