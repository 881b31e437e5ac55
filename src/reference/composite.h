// SPDX-License-Identifier: Apache-2.0
// Segments of a ray, composited front to back in double precision (docs/numerics.md, section 1):
//
//   depth = 0; color = 0
//   for each piece of the segments (cut.h), while exp(-depth) is not lost:
//       color += exp(-depth) * (opacity * colour at x = 0 + integral * change of the colour) (9.3)
//       if it is lit: light += exp(-depth) * the light on it (light.h)
//       depth += the piece's optical depth
//   alpha = 1 - exp(-depth)
//
// The errors of the integrals, of the places of ends, and of everything left out, are summed up
// beside the colours. RayIntegrator does this for the cells of a volume, whose scalars are cubics,
// and SegmentSum for tets, whose scalars are linear.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>

#include "base/arithmetic.h"
#include "lamina/transfer_function.h"
#include "optics/ray_lights.h"
#include "reference/cut.h"
#include "reference/transfer_intervals.h"

namespace lamina {

// The composite of a ray up to a depth.
class CompositedRay {
  public:
    // Tells whether everything that follows is known to be hidden, so that it need not be added.
    bool opaque() const { return depth_.value() >= depth_limit_; }
    double alpha() const;

  protected:
    // Begins a ray. Light from behind `least_transmittance`, times the brightest colour, may be
    // lost.
    void begin(const TransferIntervals& transfer, const RayLights* lights,
               double least_transmittance);
    // Returns the error of leaving out hidden segments.
    double hidden() const { return opaque() ? brightest_ * std::exp(-depth_.value()) : 0; }

    const RayLights* lights_ = nullptr;
    double brightest_ = 1;  // largest component of a colour; at least 1, for alpha
    CompensatedSum depth_;  // compensated, because thousands of pieces must not lose digits
    glm::dvec3 color_{0};
    double error_ = 0;
    double depth_limit_ = 0;  // depth behind which everything is hidden
};

// Composites cubic segments. Optical depth is exact up to rounding. Colour is integrated to a
// tolerance, with an estimate of its error.
class RayIntegrator : public CompositedRay {
  public:
    // Returns the gradient along a segment of a batch, from its front to its back in world space.
    using GradientOf = std::function<GradientAlong(std::size_t segment)>;

    // `tolerance`: largest error of every channel of a whole ray, as a share of full scale.
    RayIntegrator(const TransferIntervals& transfer, double tolerance);

    // Begins the next ray. `ray_length` > 0: world length of all segments; infinite if it is not
    // known. `lights`: for segments that are lit, must outlive the ray.
    void begin(double ray_length, const RayLights* lights = nullptr);

    // Adds the next segments; hidden ones may be among them.
    void add(const SegmentBatch& segments) { add(segments, nullptr); }
    // Adds segments that are lit. `gradient_of` is called for the visible ones.
    void add_lit(const SegmentBatch& segments, const GradientOf& gradient_of) {
        add(segments, &gradient_of);
    }

    glm::dvec3 color();  // associated
    double optical_depth() const { return depth_.value(); }
    double error_estimate();  // of the worst channel, from quadrature and early termination
    std::int64_t pieces() const { return pieces_; }

    // These are the shares of light in color(), which may be negative, and in error_estimate().
    const glm::dvec3& light() const { return light_; }
    double light_error() const { return light_error_ + hidden(); }

  private:
    void add(const SegmentBatch& segments, const GradientOf* gradient_of);
    void add_light(std::size_t piece, const GradientAlong& gradient);
    void finish_batch();

    const TransferIntervals& transfer_;
    double tolerance_;
    double error_per_opacity_;
    double error_per_length_ = 0;
    glm::dvec3 light_{0};
    double light_error_ = 0;
    std::int64_t pieces_ = 0;
    PieceBatch batch_;  // the last pieces, which are not in color_ and error_
};

// Composites linear segments, some at a time.
class SegmentSum : public CompositedRay {
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
        together_ = std::min(2 * together_, LinearSegments::capacity);
    }
    // Adds a segment that is lit, with its gradient from front to back in world space.
    void add_lit(double front, double back, const GradientAlong& gradient, double length,
                 double slack);
    // Must be called before color(), alpha() and error_estimate(): until then these lack the last
    // segments.
    void finish();

    const glm::dvec3& color() const { return color_; }  // associated
    double error_estimate() const;                      // error of the worst channel
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
    RayIntegrator light_;                             // integrates one segment at a time
    LinearSegments waiting_;                          // segments that are not in the results
    double side_errors_[LinearSegments::capacity]{};  // theirs, if nothing is in front
    bool has_side_errors_ = false;                    // one of them is not 0
    std::size_t together_ = 0;
    LinearPieces pieces_;
    std::int64_t segments_ = 0;
};

}  // namespace lamina
