// SPDX-License-Identifier: Apache-2.0
// Composites the segments of a ray front to back in double precision (docs/numerics.md, section 1):
//   depth = 0; color = 0
//   for each piece of the segments (cut.h), while exp(-depth) is not lost:
//       color += exp(-depth) * (opacity * colour at x = 0 + integral * change of the colour) (9.3)
//       if it is lit: light += exp(-depth) * the light on it (integrate.h)
//       depth += the piece's optical depth
//   alpha = 1 - exp(-depth)
// Errors of integrals, of segments' ends and of all that is left out are summed up beside the
// colours. RayIntegrator takes segments with cubic scalars (cells), SegmentSum linear ones (tets).
#pragma once

#include <functional>

#include "base/arithmetic.h"
#include "lamina/transfer_function.h"
#include "optics/ray_lights.h"
#include "reference/cut.h"
#include "reference/transfer_intervals.h"

namespace lamina {

class CompositedRay {
  public:
    // Tells whether the transmittance is so small that everything behind is hidden.
    bool opaque() const { return depth_.value() >= depth_limit_; }
    double alpha() const;

  protected:
    // Begins a new ray. Leaves out what lies behind a transmittance of `least_transmittance`
    // divided by the brightest colour: the error of a colour is then at most `least_transmittance`.
    void begin(const TransferIntervals& transfer, const RayLights* lights,
               double least_transmittance);
    // Returns a bound on the light that is left out behind an opaque ray; 0 for other rays.
    double hidden() const { return opaque() ? brightest_ * std::exp(-depth_.value()) : 0; }

    const RayLights* lights_ = nullptr;
    double brightest_ = 1;  // largest component of a colour; at least 1, for alpha
    CompensatedSum depth_;  // compensated, because thousands of pieces must not lose digits
    glm::dvec3 color_{0};
    double error_ = 0;
    double depth_limit_ = 0;  // optical depth behind which everything may be left out
};

// Composites segments with cubic scalars: optical depth exactly, colour to a tolerance.
class RayIntegrator : public CompositedRay {
  public:
    // Returns the gradient along a segment of a batch, from its front to its back in world space.
    using GradientOf = std::function<GradientAlong(std::size_t segment)>;

    // `tolerance`: largest error of every channel of a whole ray, as a share of full scale.
    RayIntegrator(const TransferIntervals& transfer, double tolerance);

    // `ray_length` > 0: world length of all segments, or infinite. `lights` must outlive the ray.
    void begin(double ray_length, const RayLights* lights = nullptr);

    // Adds segments, front to back, even to an opaque ray. If `gradient_of` is given, they are lit.
    void add(const SegmentBatch& segments, const GradientOf& gradient_of = {});

    glm::dvec3 color();  // associated
    double optical_depth() const { return depth_.value(); }
    double error_estimate();  // worst channel's, by quadrature and early termination
    std::int64_t pieces() const { return pieces_; }

    // The share of lighting in color(), perhaps negative, and in error_estimate().
    const glm::dvec3& light() const { return light_; }
    double light_error() const { return light_error_ + hidden(); }

  private:
    void add_light(std::size_t piece, const GradientAlong& gradient);
    void finish_batch();

    const TransferIntervals& transfer_;
    double tolerance_;
    double error_per_opacity_;     // allowed error per visible opacity
    double error_per_length_ = 0;  // allowed error per world unit of length
    glm::dvec3 light_{0};
    double light_error_ = 0;
    std::int64_t pieces_ = 0;
    PieceBatch batch_;  // pieces that are not in color_ and error_ yet
};

// Composites segments with linear scalars, in closed form; light to a tolerance.
class SegmentSum : public CompositedRay {
  public:
    // `place_error`: bound, in world units, on the error of segments' ends. `intervals`: those of
    // `transfer_function`; both must outlive the sum. `tolerance`: largest error of a ray's light.
    SegmentSum(const TransferFunction& transfer_function, const TransferIntervals& intervals,
               double place_error, double tolerance = 1);

    void begin(const RayLights* lights = nullptr);

    // Adds a segment on which the scalar is linear from `front` to `back`, both with errors up to
    // `slack`, over `length` > 0 world units. The caller leaves out segments that are not visible.
    void add(double front, double back, double length, double slack) {
        ++segments_;
        // A nearly constant scalar may be on the wrong side of a step by rounding.
        if (slack > 0 && std::abs(back - front) <= slack) {
            side_errors_[waiting_.count] =
                side_error(std::min(front, back) - slack, std::max(front, back) + slack, length);
            has_side_errors_ = true;
        }
        waiting_.add(front, back, length);
        if (waiting_.count < together_) return;
        finish();
        together_ = std::min(2 * together_, LinearSegments::capacity);
    }
    void add_lit(double front, double back, const GradientAlong& gradient, double length,
                 double slack);
    // Must be called before color(), alpha() and error_estimate().
    void finish();

    const glm::dvec3& color() const { return color_; }  // associated
    double error_estimate() const;                      // error of the worst channel
    std::int64_t segments() const { return segments_; }

  private:
    void forget_waiting();
    void sum_depths();
    void add_colors();
    void add_side_errors(double depth, std::size_t& segment, std::size_t end);
    double side_error(double lo, double hi, double length) const;

    const TransferFunction& transfer_function_;
    const TransferIntervals& intervals_;
    double place_error_;
    RayIntegrator light_;                             // integrates one segment at a time
    LinearSegments waiting_;                          // segments that are not in the results yet
    double side_errors_[LinearSegments::capacity]{};  // side_error() of each, not attenuated
    bool has_side_errors_ = false;                    // one of side_errors_ is not 0
    // Number of waiting segments that finish() takes together: doubles along a ray.
    std::size_t together_ = 0;
    LinearPieces pieces_;
    std::int64_t segments_ = 0;
};

}  // namespace lamina
