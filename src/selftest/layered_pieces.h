// SPDX-License-Identifier: Apache-2.0
// Rays of a layered box, cut into pieces: exactly, and as the ways to draw cut them, with bounds of
// what these may make of a piece.
#pragma once

#include <vector>

#include "lamina/transfer_function.h"
#include "selftest/layered_box.h"
#include "selftest/pixel_bounds.h"
#include "selftest/precision.h"

namespace lamina::selftest {

// Layer by layer, each in closed form (docs/numerics.md, section 5). Nothing where the ray misses
// the box.
std::vector<PieceBounds> exact_pieces(const LayeredBox& box,
                                      const TransferFunction& transfer_function,
                                      const View::Ray& ray);

// N slabs of equal thickness across the view direction, from the box's nearest to its farthest
// point in front of the eye (docs/scene.md, render.slice.samples).
struct Slabs {
    double near = 0, thickness = 0;  // eye-space depths
    int count = 0;
};
Slabs slabs_of(const LayeredBox& box, const View& view, int count);

// Classification `post`: a slab's piece of the ray shows what the scalar in its middle shows.
std::vector<PieceBounds> middle_pieces(const LayeredBox& box,
                                       const TransferFunction& transfer_function,
                                       const View::Ray& ray, const Slabs& slabs,
                                       const Precision& precision);

// `preintegrated`: a slab's piece has the exact optical depth between its ends where the scalar is
// linear between them, else one of a scalar met in it; and colours met in it.
std::vector<PieceBounds> run_pieces(const LayeredBox& box,
                                    const TransferFunction& transfer_function, const View::Ray& ray,
                                    const Slabs& slabs, const Precision& precision);

// The exact pieces as tetrahedra that conform to the layers show them: with errors of the faces
// that add up to `length_error` (world) along the ray.
std::vector<PieceBounds> tet_pieces(const LayeredBox& box,
                                    const TransferFunction& transfer_function, const View::Ray& ray,
                                    double length_error, const Precision& precision);

}  // namespace lamina::selftest
