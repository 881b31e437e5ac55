// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstddef>

#include "optics/pieces.h"

namespace lamina {

// The scalar in a tet, linear between its corners, and the region of the tet that is drawn: all of
// it, or the cell fragment whose scalars lie in one piece of the transfer function.
class PartField {
  public:
    using Corners = std::array<glm::dvec3, 4>;
    using Values = std::array<double, 4>;  // at the corners

    // `piece`: ascending; null for the whole tet. The corners must outlive it.
    PartField(const Corners& corners, const Values& values, const LinearPiece* piece);

    double least() const { return least_; }      // least scalar of the drawn region
    double largest() const { return largest_; }  // >= least
    bool cut_low() const { return cut_low_; }    // the tet also has smaller scalars
    bool cut_high() const { return cut_high_; }
    const glm::dvec3& gradient() const { return gradient_; }
    double at(const glm::dvec3& point) const {
        return values_[0] + glm::dot(gradient_, point - corners_[0]);
    }

    struct Outline {
        std::size_t count = 0;
        std::array<glm::dvec3, 8> corners;
    };
    Outline outline() const;  // the drawn region is the convex hull of these points

  private:
    const Corners& corners_;
    Values values_;
    glm::dvec3 gradient_;
    double least_, largest_;
    bool cut_low_ = false, cut_high_ = false;
};

}  // namespace lamina
