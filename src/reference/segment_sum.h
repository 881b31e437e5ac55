// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

#include "base/compensated_sum.h"
#include "lamina/transfer_function.h"
#include "reference/transfer_intervals.h"

namespace lamina {

// Composites segments of one ray, each with a linear scalar, front to back in double precision.
class SegmentSum {
  public:
    // `place_error`: bound on the error of every end of a segment, in world units.
    // `transfer_function` and `intervals` are the same function, and must outlive the sum.
    SegmentSum(const TransferFunction& transfer_function, const TransferIntervals& intervals,
               double place_error);

    // Adds the next segment: the scalar is linear from `front` to `back` over `length` world units.
    // Both scalars may have errors up to `slack`.
    void add(double front, double back, double length, double slack);

    // Whether all that follows is lost in rounding.
    bool opaque() const { return depth_.value() >= depth_limit_; }

    const glm::dvec3& color() const { return color_; }  // associated
    double alpha() const;
    double error_estimate() const;  // error of the worst channel
    std::int64_t segments() const { return segments_; }

  private:
    double side_error(double lo, double hi, double alpha, double length) const;

    const TransferFunction& transfer_function_;
    const TransferIntervals& intervals_;
    double place_error_;
    double brightest_;
    double depth_limit_;
    CompensatedSum depth_;  // compensated, because thousands of pieces must not lose digits
    glm::dvec3 color_{0};
    double error_ = 0;
    std::int64_t segments_ = 0;
};

}  // namespace lamina
