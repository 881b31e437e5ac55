// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lamina/mesh.h"
#include "lamina/transfer_function.h"
#include "meshing/trilinear_field.h"

namespace lamina {

// The largest difference between the linear function on a tet and the trilinear field.
struct TetError {
    double bound = 0;     // upper bound in the whole tet
    double found = 0;     // difference at `place`
    glm::dvec3 place{0};  // in the tet, in index space
};

enum class ErrorGoal {
    // Decides whether the tolerance is kept. If so, bound <= tolerance. If not, bound is infinite
    // and `found` is at least 0.98 of the tolerance: a large error, but not always the largest.
    decide,
    bound,  // measures the error: bound <= tolerance, or 0.98 bound <= found
};

// Measures trilinear - linear on tets by branch and bound; unlike samples, the bound holds in all
// of the tet (to some 1e-12 of the range). Blocks of cells whose range decides are not subdivided.
// In a cell the difference is trilinear, so its extremes over a box are at corners; if they do not
// decide, it is a cubic on the tet cut to the cell, bounded by its Bernstein coefficients. With a
// transfer function, only places count where it shows a value between both functions. Thread-safe.
class InterpolationError {
  public:
    // All arguments must outlive this object. `transfer_function` may be null.
    InterpolationError(const TrilinearField& field, const CellRanges& ranges,
                       const TransferFunction* transfer_function)
        : field_(field), ranges_(ranges), transfer_function_(transfer_function) {}

    // `corners`: in index space, any orientation. A tet without volume has no error.
    TetError measure(const std::array<glm::dvec3, 4>& corners, const std::array<double, 4>& values,
                     double tolerance, ErrorGoal goal) const;

    // Returns the largest bound over a whole mesh with points in index space. Parallel.
    double largest(std::span<const glm::dvec3> points, std::span<const double> values,
                   std::span<const Tet> tets, double tolerance) const;

  private:
    const TrilinearField& field_;
    const CellRanges& ranges_;
    const TransferFunction* transfer_function_;
};

}  // namespace lamina
