// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/vec3.hpp>

#include "base/compensated_sum.h"
#include "optics/ray_lights.h"
#include "reference/cubic.h"
#include "reference/emission_batch.h"
#include "reference/emission_integral.h"
#include "reference/gradient_samples.h"
#include "reference/transfer_intervals.h"

namespace lamina {

// Emission and absorption along one ray, accumulated front to back in double precision
// (docs/numerics.md, section 1). Optical depth is exact up to rounding. Colour is integrated to a
// tolerance, with an estimate of its error.
class RayIntegrator {
  public:
    // `tolerance`: largest error of every channel of the whole ray, as a share of full scale.
    // `ray_length` > 0: world length of all segments; infinite where it is not known. `lights`: for
    // add_lit(), must outlive this.
    RayIntegrator(const TransferIntervals& transfer, double tolerance, double ray_length,
                  const RayLights* lights = nullptr);

    // Adds the next segment, of `length` > 0 world units. `scalar` is the scalar from its front to
    // its back, which stays inside [lo, hi] up to rounding.
    void add(const Cubic& scalar, double lo, double hi, double length) {
        add(scalar, nullptr, lo, hi, length);
    }
    // The same of a segment that is lit, with its gradient from front to back in world space.
    void add_lit(const Cubic& scalar, const GradientAlong& gradient, double lo, double hi,
                 double length) {
        add(scalar, &gradient, lo, hi, length);
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
    // Here `gradient` is null for what is not lit.
    void add(const Cubic& scalar, const GradientAlong* gradient, double lo, double hi,
             double length);
    void add_split(const Cubic& scalar, const GradientAlong* gradient, double length);
    void add_part(std::size_t interval, const Cubic& scalar, const GradientAlong* gradient,
                  double from, double to, double start, double end, double length);
    void add_piece(const TransferInterval& interval, const Cubic& scalar,
                   const GradientAlong* gradient, double length);
    void add_light(const TransferInterval& interval, const EmissionPiece& emission,
                   const GradientAlong& gradient, double length);
    void finish_batch();
    double hidden() const { return opaque() ? brightest_ * std::exp(-depth_.value()) : 0; }

    const TransferIntervals& transfer_;
    const RayLights* lights_;
    double brightest_;  // at least 1, for alpha
    double depth_limit_;
    double error_per_opacity_;
    double error_per_length_;
    CompensatedSum depth_;  // compensated, because thousands of pieces must not lose digits
    glm::dvec3 color_{0};
    double error_ = 0;
    glm::dvec3 light_{0};
    double light_error_ = 0;
    std::int64_t pieces_ = 0;
    EmissionBatch batch_;  // of the last pieces, which are not in color_ and error_
    const TransferInterval* intervals_[EmissionBatch::capacity];
};

}  // namespace lamina
