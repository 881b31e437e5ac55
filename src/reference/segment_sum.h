// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>

#include "base/compensated_sum.h"
#include "lamina/transfer_function.h"
#include "optics/ray_lights.h"
#include "reference/cells.h"
#include "reference/linear_batch.h"
#include "reference/linear_parts.h"
#include "reference/ray_integrator.h"
#include "reference/transfer_intervals.h"

namespace lamina {

// Composites segments of rays, each with a linear scalar, front to back in double precision. They
// are summed some at a time.
class SegmentSum {
  public:
    // `place_error`: bound on the error of every end of a segment, in world units.
    // `transfer_function` and `intervals` are the same function, and must outlive the sum.
    // `tolerance`: for add_lit(), largest error of the light of all segments of a ray together.
    SegmentSum(const TransferFunction& transfer_function, const TransferIntervals& intervals,
               double place_error, double tolerance = 1);

    // Begins the next ray. `lights`: for add_lit(), must outlive the ray.
    void begin(const RayLights* lights = nullptr);

    // Adds the next segment: the scalar is linear from `front` to `back` over `length` world units.
    // Both scalars may have errors up to `slack`. `length` > 0. The caller leaves out segments that
    // are not visible (TransferIntervals::visible()): they would only be counted.
    void add(double front, double back, double length, double slack) {
        ++segments_;
        if (slack > 0 && std::abs(back - front) <= slack)
            note_side_error(std::min(front, back) - slack, std::max(front, back) + slack, length);
        waiting_.add(front, back, length);
        if (waiting_.count < together_) return;
        finish();
        together_ = std::min(2 * together_, LinearBatch::capacity);
    }
    // The same of a segment that is lit, with its gradient from front to back in world space.
    void add_lit(double front, double back, const GradientAlong& gradient, double length,
                 double slack);
    // To be called before color(), alpha() and error_estimate(): until then these lack the last
    // segments.
    void finish();

    // Whether all that follows is lost in rounding, as far as is known.
    bool opaque() const { return depth_.value() >= depth_limit_; }

    const glm::dvec3& color() const { return color_; }  // associated
    double alpha() const;
    double error_estimate() const;  // error of the worst channel
    std::int64_t segments() const { return segments_; }

  private:
    void forget_waiting();
    void sum_depths();
    void add_colors();
    void add_side_errors(double depth, std::size_t& segment, std::size_t end);
    void add_light(double front, double back, const GradientAlong& gradient, double length);
    void note_side_error(double lo, double hi, double length);
    double side_error(double lo, double hi, double length) const;

    const TransferFunction& transfer_function_;
    const TransferIntervals& intervals_;
    double place_error_;
    const RayLights* lights_ = nullptr;
    RayIntegrator light_;  // of one segment at a time
    double brightest_ = 1;
    double depth_limit_ = 0;
    LinearBatch waiting_;                          // segments that are not in the results
    double side_errors_[LinearBatch::capacity]{};  // theirs, if nothing lay in front of them
    bool has_side_errors_ = false;                 // whether one of them is not 0
    std::size_t together_ = 0;
    LinearParts parts_;
    CompensatedSum depth_;  // compensated, because thousands of pieces must not lose digits
    glm::dvec3 color_{0};
    double error_ = 0;
    std::int64_t segments_ = 0;
};

}  // namespace lamina
