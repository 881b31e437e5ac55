// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>

#include "base/compensated_sum.h"
#include "optics/ray_lights.h"
#include "reference/cells.h"
#include "reference/cut.h"
#include "reference/piece_batch.h"
#include "reference/transfer_intervals.h"

namespace lamina {

// Emission and absorption along rays, accumulated front to back in double precision
// (docs/numerics.md, section 1). Optical depth is exact up to rounding. Colour is integrated to a
// tolerance, with an estimate of its error.
class RayIntegrator {
  public:
    // The gradient along a segment of a batch, from its front to its back in world space.
    using GradientOf = std::function<GradientAlong(std::size_t segment)>;

    // `tolerance`: largest error of every channel of a whole ray, as a share of full scale.
    RayIntegrator(const TransferIntervals& transfer, double tolerance);

    // Begins the next ray. `ray_length` > 0: world length of all segments; infinite where it is not
    // known. `lights`: for segments that are lit, must outlive the ray.
    void begin(double ray_length, const RayLights* lights = nullptr);

    // Adds the next segments; those that are hidden may be among them.
    void add(const SegmentBatch& segments) { add(segments, nullptr); }
    // The same of segments that are lit. `gradient_of` is called for those that are seen.
    void add_lit(const SegmentBatch& segments, const GradientOf& gradient_of) {
        add(segments, &gradient_of);
    }

    // Whether all that follows is hidden, so that no more segments need to be added.
    bool opaque() const { return depth_.value() >= depth_limit_; }

    glm::dvec3 color();  // associated
    double alpha() const;
    double optical_depth() const { return depth_.value(); }
    // Error of the worst channel, from quadrature and early termination.
    double error_estimate();
    std::int64_t pieces() const { return pieces_; }

    // The share of light in color(), which may be negative, and in error_estimate().
    const glm::dvec3& light() const { return light_; }
    double light_error() const { return light_error_ + hidden(); }

  private:
    void add(const SegmentBatch& segments, const GradientOf* gradient_of);
    void add_light(std::size_t piece, const GradientAlong& gradient);
    void finish_batch();
    double hidden() const { return opaque() ? brightest_ * std::exp(-depth_.value()) : 0; }

    const TransferIntervals& transfer_;
    double tolerance_;
    double error_per_opacity_;
    const RayLights* lights_ = nullptr;
    double brightest_ = 1;  // at least 1, for alpha
    double depth_limit_ = 0;
    double error_per_length_ = 0;
    CompensatedSum depth_;  // compensated, because thousands of pieces must not lose digits
    glm::dvec3 color_{0};
    double error_ = 0;
    glm::dvec3 light_{0};
    double light_error_ = 0;
    std::int64_t pieces_ = 0;
    PieceBatch batch_;  // the last pieces, which are not in color_ and error_
};

}  // namespace lamina
