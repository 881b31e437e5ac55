// SPDX-License-Identifier: Apache-2.0
#include "reference/composite.h"

#include <glm/common.hpp>

#include "optics/opacity.h"
#include "reference/integrate.h"

namespace lamina {
namespace {

// Share of the tolerance that may be lost because rays end early.
constexpr double termination_share = 1e-3;

// Number of pieces that are integrated together, so that vectors are full.
constexpr std::size_t pieces_together = 32;

// Optical depth that is set in front of hidden pieces: exp(-1e4) is 0, so they add nothing.
constexpr double hidden_depth = 1e4;

GradientAlong restricted(const GradientAlong& gradient, double from, double to) {
    GradientAlong inside;
    for (std::size_t c = 0; c < 3; ++c)
        inside[c] = restricted(gradient[c], from, to, gradient[c](from), gradient[c](to));
    return inside;
}

// Transmittance, times the brightest colour, below which light is lost in rounding.
constexpr double rounded_transmittance = 1e-17;
// Relative error of a piece's colour and opacity (weigh_pieces()), and of its interpolation.
constexpr double piece_error = 1e-13;
// Number of segments that are summed first: few, because they may hide the others.
constexpr std::size_t first_together = 8;

}  // namespace

void CompositedRay::begin(const TransferIntervals& transfer, const RayLights* lights,
                          double least_transmittance) {
    lights_ = lights;
    brightest_ = std::max(1.0, lights != nullptr ? lights->brightest_lit(transfer.brightest())
                                                 : transfer.brightest());
    depth_limit_ = std::log(brightest_ / least_transmittance);
    depth_ = {};
    color_ = glm::dvec3(0);
    error_ = 0;
}

double CompositedRay::alpha() const {
    return opacity_from_depth(depth_.value());
}

// Allows tolerance / 4 for errors by length and for those by opacity (shares of each kind add up to
// at most 1), so half of the tolerance for colour. add_light() allows the other half for light.
RayIntegrator::RayIntegrator(const TransferIntervals& transfer, double tolerance)
    : transfer_(transfer), tolerance_(tolerance), error_per_opacity_(tolerance / 4) {
    batch_.error_of_opacity = error_per_opacity_;
}

void RayIntegrator::begin(double ray_length, const RayLights* lights) {
    CompositedRay::begin(transfer_, lights, termination_share * tolerance_);
    error_per_length_ = tolerance_ / 4 / ray_length;
    light_ = glm::dvec3(0);
    light_error_ = 0;
    pieces_ = 0;
    batch_.count = 0;
}

void RayIntegrator::add(const SegmentBatch& segments, const GradientOf& gradient_of) {
    const std::size_t first = batch_.count;
    std::int64_t lit_segment = -1;
    GradientAlong gradient;
    append_pieces(segments, transfer_, error_per_length_, batch_);
    CompensatedSum depth = depth_;  // local: a member would be written to memory with every piece
    for (std::size_t piece = first; piece < batch_.count; ++piece) {
        const double before = depth.value();
        const bool hidden = before >= depth_limit_;
        batch_.before[piece] = hidden ? hidden_depth : before;
        if (hidden) continue;
        ++pieces_;
        if (gradient_of) {
            const std::int64_t segment = batch_.segment[piece];
            if (segment != lit_segment) gradient = gradient_of(segment);
            lit_segment = segment;
            add_light(piece, gradient);
        }
        depth.add(batch_.depth[piece]);
    }
    depth_ = depth;
    if (batch_.count >= pieces_together) finish_batch();
}

void RayIntegrator::finish_batch() {
    integrate_emission(batch_);
    glm::dvec3 sum = color_;
    double error = error_;
    for (std::size_t i = 0; i < batch_.count; ++i) {
        const double transmittance = batch_.transmittance[i];
        if (!(transmittance > 0)) continue;
        const auto& [color, change] = transfer_.color(static_cast<std::size_t>(batch_.interval[i]));
        sum += transmittance * batch_.opacity[i] * color;
        if (!(batch_.color_span[i] > 0)) continue;
        sum += transmittance * batch_.value[i] * change;
        error += transmittance * batch_.color_span[i] * batch_.error[i];
    }
    color_ = sum;
    error_ = error;
    batch_.count = 0;
}

void RayIntegrator::add_light(std::size_t piece, const GradientAlong& gradient) {
    const auto& [color, change] = transfer_.color(static_cast<std::size_t>(batch_.interval[piece]));
    const double transmittance = std::exp(-batch_.before[piece]);
    const LightIntegral light = integrate_light(
        {batch_.piece(piece), color, change,
         restricted(gradient, batch_.from[piece], batch_.to[piece])},
        *lights_, 0.5 * batch_.error_of_length[piece] / transmittance, 0.5 * error_per_opacity_);
    light_ += transmittance * light.value;
    light_error_ += transmittance * light.error;
}

glm::dvec3 RayIntegrator::color() {
    finish_batch();
    // Rounding may leave -1e-17 of a colour that fades to 0.
    return glm::max(color_ + light_, glm::dvec3(0));
}

double RayIntegrator::error_estimate() {
    finish_batch();
    return error_ + light_error_ + hidden();
}

SegmentSum::SegmentSum(const TransferFunction& transfer_function,
                       const TransferIntervals& intervals, double place_error, double tolerance)
    : transfer_function_(transfer_function),
      intervals_(intervals),
      place_error_(place_error),
      light_(intervals, tolerance) {
    begin();
}

void SegmentSum::begin(const RayLights* lights) {
    CompositedRay::begin(intervals_, lights, rounded_transmittance);
    together_ = first_together;
    forget_waiting();
    segments_ = 0;
}

void SegmentSum::finish() {
    pieces_.count = 0;
    append_linear_pieces(waiting_, intervals_.columns(), pieces_);
    sum_depths();
    weigh_pieces(pieces_);
    add_colors();
    forget_waiting();
}

void SegmentSum::forget_waiting() {
    waiting_.count = 0;
    if (has_side_errors_) std::ranges::fill(side_errors_, 0);
    has_side_errors_ = false;
}

// Sums are kept in local variables: members would be written to memory with every piece.
void SegmentSum::sum_depths() {
    CompensatedSum depth = depth_;
    std::size_t segment = 0;  // the first segment whose side error is not added
    for (std::size_t i = 0; i < pieces_.count; ++i) {
        const auto end = static_cast<std::size_t>(pieces_.segment[i]) + 1;
        if (has_side_errors_) add_side_errors(depth.value(), segment, end);
        pieces_.before[i] = depth.value();
        depth.add(pieces_.depth[i]);
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
    for (std::size_t i = 0; i < pieces_.count; ++i) {
        const double transmittance = pieces_.transmittance[i];
        if (!(transmittance > 0)) continue;
        const auto interval = static_cast<std::size_t>(pieces_.interval[i]);
        const auto& [color, change] = intervals_.color(interval);
        sum += transmittance * pieces_.opacity[i] * color;
        if (intervals_.columns().color_span[interval] > 0)
            sum += transmittance * pieces_.change[i] * change;
        // If an end of a piece is off, this much optical depth moves to the neighbouring piece.
        const double length = waiting_.length[pieces_.segment[i]];
        const double moved = std::min(1.0, 2 * place_error_ * pieces_.depth[i] / length);
        error += transmittance * (piece_error * pieces_.opacity[i] + moved);
    }
    color_ = sum;
    error_ += brightest_ * error;
}

// Adds the unlit segment in closed form, and to it the integral of the light.
void SegmentSum::add_lit(double front, double back, const GradientAlong& gradient, double length,
                         double slack) {
    const auto [lo, hi] = std::minmax(front, back);
    if (intervals_.visible(lo, hi)) {
        finish();
        constexpr double unknown_length = std::numeric_limits<double>::infinity();
        light_.begin(unknown_length, lights_);
        SegmentBatch alone;
        alone.add({{front, back - front}}, lo, hi, length);
        light_.add(alone, [&](std::size_t) { return gradient; });
        const double transmittance = std::exp(-depth_.value());
        color_ += transmittance * light_.light();
        error_ += transmittance * light_.light_error();
    }
    add(front, back, length, slack);
}

// Returns a bound on the result's change if a nearly constant scalar were elsewhere in [lo, hi].
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

double SegmentSum::error_estimate() const {
    return std::min(brightest_, error_ + hidden());  // no channel can be off by more
}

}  // namespace lamina
