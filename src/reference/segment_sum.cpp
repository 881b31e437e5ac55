// SPDX-License-Identifier: Apache-2.0
#include "reference/segment_sum.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

#include "optics/opacity.h"
#include "optics/segment_integral.h"
#include "reference/segment_weights.h"

namespace lamina {
namespace {

// Light from behind this transmittance, times the brightest colour, is lost in rounding.
constexpr double least_transmittance = 1e-17;
// The relative error of a segment's colour and opacity (optics/segment_integral.h).
constexpr double segment_error = 1e-13;

}  // namespace

SegmentSum::SegmentSum(const TransferFunction& transfer_function,
                       const TransferIntervals& intervals, double place_error,
                       const RayLights* lights, double tolerance)
    : transfer_function_(transfer_function),
      intervals_(intervals),
      place_error_(place_error),
      lights_(lights),
      light_(intervals, tolerance),
      brightest_(std::max(1.0, lights != nullptr ? lights->brightest_lit(intervals.brightest())
                                                 : intervals.brightest())),
      depth_limit_(std::log(brightest_ / least_transmittance)) {}

void SegmentSum::add(double front, double back, double length, double slack) {
    const auto [lo, hi] = std::minmax(front, back);
    if (!(length > 0) || !intervals_.visible(lo - slack, hi + slack)) return;
    ++segments_;
    const SegmentIntegral segment =
        integrate_segment(transfer_function_, front, back, length, segment_weights);
    const double transmittance = std::exp(-depth_.value());
    color_ += transmittance * segment.color;
    // Where an end is off, this much depth moves from one side of it to the other.
    const double moved = std::min(1.0, 2 * place_error_ * segment.optical_depth / length);
    error_ += transmittance * brightest_ * (segment_error * segment.alpha + moved);
    if (hi - lo <= slack && slack > 0)
        error_ += transmittance * side_error(lo - slack, hi + slack, segment.alpha, length);
    depth_.add(segment.optical_depth);
}

// The unlit segment stays what it is, in closed form: light is added to it.
void SegmentSum::add_lit(double front, double back, const GradientAlong& gradient, double length,
                         double slack) {
    if (!(length > 0)) return;
    const auto [lo, hi] = std::minmax(front, back);
    if (intervals_.visible(lo, hi)) add_light(front, back, gradient, length);
    add(front, back, length, slack);
}

void SegmentSum::add_light(double front, double back, const GradientAlong& gradient,
                           double length) {
    constexpr double unknown_length = std::numeric_limits<double>::infinity();
    light_.begin(unknown_length, lights_);
    const auto [lo, hi] = std::minmax(front, back);
    SegmentBatch alone;
    alone.add({{front, back - front}}, lo, hi, length);
    light_.add_lit(alone, [&](std::size_t) { return gradient; });
    const double transmittance = std::exp(-depth_.value());
    color_ += transmittance * light_.light();
    error_ += transmittance * light_.light_error();
}

// Returns what would change if the scalar of a segment that is all but constant were elsewhere in
// [lo, hi]: its rounding may choose the side of a step of the transfer function.
double SegmentSum::side_error(double lo, double hi, double alpha, double length) const {
    const OpticalProperties below = transfer_function_.at(lo), above = transfer_function_.at(hi);
    const double depth = std::min(1.0, std::abs(above.extinction - below.extinction) * length);
    const double lit = lights_ != nullptr ? lights_->largest_factor() : 1;
    const glm::dvec3 color = lit * glm::abs(above.color - below.color);
    return brightest_ * depth + std::max({color.r, color.g, color.b}) * std::max(alpha, depth);
}

double SegmentSum::alpha() const {
    return opacity_from_depth(depth_.value());
}

double SegmentSum::error_estimate() const {
    const double hidden = opaque() ? brightest_ * std::exp(-depth_.value()) : 0;
    return std::min(brightest_, error_ + hidden);  // no channel can be farther off
}

}  // namespace lamina
