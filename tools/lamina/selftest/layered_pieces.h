// SPDX-License-Identifier: Apache-2.0
// Rays through a layered box, cut into pieces: exactly, and as the drawing methods cut them, with
// bounds on what a method may make of each piece.
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <vector>

#include "lamina/settings.h"
#include "lamina/transfer_function.h"
#include "selftest/layered_box.h"
#include "selftest/pixel_bounds.h"

namespace lamina::selftest {

// Returns the exact pieces, one for each layer, in closed form (docs/numerics.md, section 5); none
// if the ray misses the box.
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

// Returns the pieces of classification `post`: in each slab the optics of the scalar in the middle
// of the ray's segment.
std::vector<PieceBounds> middle_pieces(const LayeredBox& box,
                                       const TransferFunction& transfer_function,
                                       const View::Ray& ray, const Slabs& slabs,
                                       const Precision& precision);

// Returns the pieces of classification `preintegrated`. If the scalar is linear in a slab, the
// optical depth is exact except for rounding. Otherwise it may be that of any scalar in the slab.
// The colour may be any that occurs in the slab.
std::vector<PieceBounds> run_pieces(const LayeredBox& box,
                                    const TransferFunction& transfer_function, const View::Ray& ray,
                                    const Slabs& slabs, const Precision& precision);

// Returns the pieces that tets draw if they conform to the layers. `length_error`: bound on the sum
// of the errors of all lengths along the ray, in world units.
std::vector<PieceBounds> tet_pieces(const LayeredBox& box,
                                    const TransferFunction& transfer_function, const View::Ray& ray,
                                    double length_error, const Precision& precision);

// Light along a ray on which the gradient is constant, as in a box of one layer: the lit colour is
// a factor times the unlit one, plus a highlight times opacity (docs/numerics.md, section 10). If
// there is only ambient light of 1, the factor is 1 in any box.
class OneGradientLight {
  public:
    OneGradientLight(const Lighting& lighting, const LayeredBox& box, const View::Ray& ray);

    void shine_on(std::array<double, 4>& pixel) const;
    // `error`: error of factor and highlight, as a share of the sum of all terms.
    void shine_on(PixelBounds& pixel, double error) const;

  private:
    glm::dvec3 factor_{1}, highlight_{0};
    double terms_ = 0;
};

}  // namespace lamina::selftest
