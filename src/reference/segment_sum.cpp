// SPDX-License-Identifier: Apache-2.0
#include "reference/segment_sum.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

#include "optics/opacity.h"

namespace lamina {
namespace {

// Light from behind this transmittance, times the brightest colour, is lost in rounding.
constexpr double least_transmittance = 1e-17;
// The relative error of a part's colour and opacity (weigh_parts()), and of its interpolations.
constexpr double part_error = 1e-13;
// So many segments are summed first: they may hide the others.
constexpr std::size_t first_together = 8;

}  // namespace

SegmentSum::SegmentSum(const TransferFunction& transfer_function,
                       const TransferIntervals& intervals, double place_error, double tolerance)
    : transfer_function_(transfer_function),
      intervals_(intervals),
      place_error_(place_error),
      light_(intervals, tolerance) {
    begin();
}

void SegmentSum::begin(const RayLights* lights) {
    lights_ = lights;
    brightest_ = std::max(1.0, lights != nullptr ? lights->brightest_lit(intervals_.brightest())
                                                 : intervals_.brightest());
    depth_limit_ = std::log(brightest_ / least_transmittance);
    together_ = first_together;
    forget_waiting();
    depth_ = {};
    color_ = glm::dvec3(0);
    error_ = 0;
    segments_ = 0;
}

// What the result would change by if the scalar of a segment that is all but constant were
// elsewhere in [lo, hi]: its rounding may choose the side of a step of the transfer function.
void SegmentSum::note_side_error(double lo, double hi, double length) {
    side_errors_[waiting_.count] = side_error(lo, hi, length);
    has_side_errors_ = true;
}

void SegmentSum::finish() {
    parts_.count = 0;
    append_parts(waiting_, intervals_.columns(), parts_);
    sum_depths();
    weigh_parts(parts_);
    add_colors();
    forget_waiting();
}

void SegmentSum::forget_waiting() {
    waiting_.count = 0;
    if (has_side_errors_) std::ranges::fill(side_errors_, 0);
    has_side_errors_ = false;
}

// Sums are kept in local variables: members would be written to memory with every part.
void SegmentSum::sum_depths() {
    CompensatedSum depth = depth_;
    std::size_t segment = 0;  // the first whose side error is not added
    for (std::size_t i = 0; i < parts_.count; ++i) {
        const auto end = static_cast<std::size_t>(parts_.segment[i]) + 1;
        if (has_side_errors_) add_side_errors(depth.value(), segment, end);
        parts_.before[i] = depth.value();
        depth.add(parts_.depth[i]);
    }
    if (has_side_errors_) add_side_errors(depth.value(), segment, waiting_.count);
    depth_ = depth;
}

void SegmentSum::add_side_errors(double depth, std::size_t& segment, std::size_t end) {
    for (; segment < end; ++segment) {
        if (side_errors_[segment] > 0) error_ += std::exp(-depth) * side_errors_[segment];
    }
}

void SegmentSum::add_colors() {
    glm::dvec3 sum = color_;
    double error = 0;
    for (std::size_t i = 0; i < parts_.count; ++i) {
        const double transmittance = parts_.transmittance[i];
        if (!(transmittance > 0)) continue;
        const auto interval = static_cast<std::size_t>(parts_.interval[i]);
        const auto& [color, change] = intervals_.color(interval);
        sum += transmittance * parts_.opacity[i] * color;
        if (intervals_.columns().color_span[interval] > 0)
            sum += transmittance * parts_.change[i] * change;
        // Where an end is off, this much depth moves from one side of it to the other.
        const double length = waiting_.length[static_cast<std::size_t>(parts_.segment[i])];
        const double moved = std::min(1.0, 2 * place_error_ * parts_.depth[i] / length);
        error += transmittance * (part_error * parts_.opacity[i] + moved);
    }
    color_ = sum;
    error_ += brightest_ * error;
}

// The unlit segment stays what it is, in closed form: light is added to it.
void SegmentSum::add_lit(double front, double back, const GradientAlong& gradient, double length,
                         double slack) {
    const auto [lo, hi] = std::minmax(front, back);
    if (intervals_.visible(lo, hi)) add_light(front, back, gradient, length);
    add(front, back, length, slack);
}

void SegmentSum::add_light(double front, double back, const GradientAlong& gradient,
                           double length) {
    finish();
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

double SegmentSum::side_error(double lo, double hi, double length) const {
    const OpticalProperties below = transfer_function_.at(lo), above = transfer_function_.at(hi);
    const double depth = std::min(1.0, std::abs(above.extinction - below.extinction) * length);
    const double middle = transfer_function_.at(0.5 * lo + 0.5 * hi).extinction;
    const double alpha =
        opacity_from_depth(std::max({above.extinction, middle, below.extinction}) * length);
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
