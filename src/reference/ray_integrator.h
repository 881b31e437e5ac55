// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

#include "base/compensated_sum.h"
#include "reference/cubic.h"
#include "reference/transfer_intervals.h"

namespace lamina {

// Emission and absorption along one ray, accumulated front to back in double precision
// (docs/numerics.md, section 1). Optical depth is exact up to rounding. Colour is integrated to a
// tolerance, with an estimate of its error.
class RayIntegrator {
  public:
    // `tolerance`: largest error of every channel of the whole ray, as a share of full scale.
    // `ray_length` > 0: world length of all segments.
    RayIntegrator(const TransferIntervals& transfer, double tolerance, double ray_length);

    // Adds the next segment, of `length` > 0 world units. `scalar` is the scalar from its front to
    // its back, which stays inside [lo, hi] up to rounding.
    void add(const Cubic& scalar, double lo, double hi, double length);

    // Whether all that follows is hidden, so that no more segments need to be added.
    bool opaque() const { return depth_.value() >= depth_limit_; }

    glm::dvec3 color() const;  // associated
    double alpha() const;
    // Error of the worst channel, from quadrature and early termination.
    double error_estimate() const;
    std::int64_t pieces() const { return pieces_; }

  private:
    void add_split(const Cubic& scalar, double length);
    void add_part(std::size_t interval, const Cubic& scalar, double from, double to, double start,
                  double end, double length);
    void add_piece(const TransferInterval& interval, const Cubic& scalar, double length);

    const TransferIntervals& transfer_;
    double brightest_;  // at least 1, for alpha
    double depth_limit_;
    double error_per_opacity_;
    double error_per_length_;
    CompensatedSum depth_;  // compensated, because thousands of pieces must not lose digits
    glm::dvec3 color_{0};
    double error_ = 0;
    std::int64_t pieces_ = 0;
};

}  // namespace lamina
