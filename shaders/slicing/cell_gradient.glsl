// SPDX-License-Identifier: Apache-2.0
// Computes the gradient along a part of a ray inside one cell of the grid.
#include "optics/cubic.glsl"
#include "slicing/cell_cubic.glsl"
#include "volume/gradient.glsl"

// The gradient's components along the grid's axes, each a cubic, and the square of the smallest
// gradient that is lit (Lighting::smallest_gradient) in the same unit.
struct CellGradient {
    vec4 x, y, z;
    float smallest_square;
};

vec3 gradient_along(CellGradient gradient, float t) {
    return vec3(cubic_at(gradient.x, t), cubic_at(gradient.y, t), cubic_at(gradient.z, t));
}

// Returns one component of the gradients at a cell's corners.
Corners corners_of(vec3 lower[4], vec3 upper[4], int axis) {
    return Corners(vec4(lower[0][axis], lower[1][axis], lower[2][axis], lower[3][axis]),
                   vec4(upper[0][axis], upper[1][axis], upper[2][axis], upper[3][axis]));
}

// Returns the gradient along the part of a ray from `place`, counted from the cell's lowest corner,
// to place + change. Beyond the samples (axes with `cell` centering) both corners on an axis are
// the border sample. An inner sample is not read there, because its gradient may be so long that
// adding and subtracting it would lose all digits.
CellGradient cell_gradient(ivec3 cell, vec3 place, vec3 change) {
    ivec3 last = ivec3(last_sample);
    ivec3 lower = clamp(cell, ivec3(0), last), upper = clamp(cell + 1, ivec3(0), last);
    CornerGradients corners = corner_gradients(lower, upper);
    return CellGradient(cubic_along(corners_of(corners.lower_x, corners.upper_x, 0), 0.0, place, change),
                        cubic_along(corners_of(corners.lower_x, corners.upper_x, 1), 0.0, place, change),
                        cubic_along(corners_of(corners.lower_x, corners.upper_x, 2), 0.0, place, change),
                        smallest_square_in_unit(corners.largest));
}
