// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

#include "base/compensated_sum.h"
#include "reference/cubic.h"
#include "reference/transfer_intervals.h"

namespace lamina {

// Emission and absorption along one ray, collected front to back in double precision
// (docs/numerics.md, section 1). Optical depth is exact but for rounding; colour is integrated to a
// tolerance, with an estimate of its error.
class RayIntegrator {
  public:
    // `tolerance`: of full scale, for every channel of the whole ray. `ray_length` > 0: world
    // length of all segments.
    RayIntegrator(const TransferIntervals& transfer, double tolerance, double ray_length);

    // The next segment, `length` > 0 world units long: the scalar runs as `scalar` from its front
    // to its back and stays (but for rounding) inside [lo, hi].
    void add(const Cubic& scalar, double lo, double hi, double length);

    // True once what follows cannot matter: segments need no longer be added.
    bool opaque() const { return depth_.value() >= depth_limit_; }

    glm::dvec3 color() const;  // associated
    double alpha() const;
    double error_estimate() const;  // of the worst channel: quadrature and early termination
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
    CompensatedSum depth_;  // thousands of pieces must not lose digits
    glm::dvec3 color_{0};
    double error_ = 0;
    std::int64_t pieces_ = 0;
};

}  // namespace lamina
