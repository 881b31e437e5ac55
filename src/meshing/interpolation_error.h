// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <span>

#include "lamina/tet.h"
#include "lamina/transfer_function.h"
#include "meshing/cell_ranges.h"
#include "meshing/trilinear_field.h"

namespace lamina {

// How far the linear function on a tet is from the trilinear field.
struct TetError {
    double bound = 0;     // nowhere in the tet more than this
    double found = 0;     // this much at `place`
    glm::dvec3 place{0};  // in the tet, index space
};

// What measure() is to find out.
enum class ErrorGoal {
    decide,  // whether the tolerance holds: bound <= tolerance; or bound is infinite, and `found`
             // at least 0.98 of the tolerance, a large error though not always the largest
    bound,   // bound <= tolerance, or 0.98 bound <= found
};

// Measures |trilinear - linear| on tets by branch and bound, so that the bound is a certificate and
// not a sample (in double precision: to some 1e-12 of the range). Blocks of cells that the field's
// range decides are never looked into; in a cell the difference is trilinear, so its extremes over
// a box are at the box's corners; where a tet cuts the cell and that does not decide, the part of
// the tet in the cell is cut out, and the difference, a cubic there, is bounded by its Bernstein
// coefficients. With a transfer function, places where it shows nothing of any value between the
// two functions do not count. Thread-safe.
class InterpolationError {
  public:
    // All arguments must outlive this. `transfer_function` may be null.
    InterpolationError(const TrilinearField& field, const CellRanges& ranges,
                       const TransferFunction* transfer_function)
        : field_(field), ranges_(ranges), transfer_function_(transfer_function) {}

    // The tet with `corners` (index space, in the field's box; any orientation) and the values of
    // the linear function there. A tet without volume has no error.
    TetError measure(const std::array<glm::dvec3, 4>& corners, const std::array<double, 4>& values,
                     double tolerance, ErrorGoal goal) const;

    // The largest bound over a whole mesh, points in index space. Parallel, with progress.
    double largest(std::span<const glm::dvec3> points, std::span<const double> values,
                   std::span<const Tet> tets, double tolerance) const;

  private:
    const TrilinearField& field_;
    const CellRanges& ranges_;
    const TransferFunction* transfer_function_;
};

}  // namespace lamina
