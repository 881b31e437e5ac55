// SPDX-License-Identifier: Apache-2.0
#include "reference/ray_integrator.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "optics/opacity.h"
#include "reference/light_integral.h"
#include "reference/segment_pieces.h"

namespace lamina {
namespace {

// Early termination may cost this share of the tolerance. The rest of the ray's colour is at most
// its transmittance times the brightest colour.
constexpr double termination_share = 1e-3;

// Pieces are integrated when there are so many, so that vectors are full.
constexpr std::size_t pieces_together = 32;

// Hidden pieces get this optical depth in front of them: exp(-x) of it is 0, so they add nothing.
constexpr double hidden_depth = 1e4;

GradientAlong part_of(const GradientAlong& gradient, double from, double to) {
    GradientAlong part;
    for (std::size_t c = 0; c < 3; ++c)
        part[c] = part_of(gradient[c], from, to, gradient[c](from), gradient[c](to));
    return part;
}

}  // namespace

// The errors allowed to pieces, by their share of the length and by their share of the opacity, add
// up to half of the tolerance, because the shares of either kind add up to at most 1. Those allowed
// to light add up to half of that.
RayIntegrator::RayIntegrator(const TransferIntervals& transfer, double tolerance)
    : transfer_(transfer), tolerance_(tolerance), error_per_opacity_(tolerance / 4) {
    batch_.error_of_opacity = error_per_opacity_;
}

void RayIntegrator::begin(double ray_length, const RayLights* lights) {
    lights_ = lights;
    brightest_ = std::max(1.0, lights != nullptr ? lights->brightest_lit(transfer_.brightest())
                                                 : transfer_.brightest());
    depth_limit_ = std::log(brightest_ / (termination_share * tolerance_));
    error_per_length_ = tolerance_ / 4 / ray_length;
    depth_ = {};
    color_ = light_ = glm::dvec3(0);
    error_ = light_error_ = 0;
    pieces_ = 0;
    batch_.count = 0;
}

void RayIntegrator::add(const SegmentBatch& segments, const GradientOf* gradient_of) {
    const std::size_t first = batch_.count;
    std::int64_t lit_segment = -1;
    GradientAlong gradient;
    append_pieces(segments, transfer_, error_per_length_, batch_);
    // A local sum: a member would be written to memory with every piece.
    CompensatedSum depth = depth_;
    for (std::size_t piece = first; piece < batch_.count; ++piece) {
        const double before = depth.value();
        const bool hidden = before >= depth_limit_;
        batch_.before[piece] = hidden ? hidden_depth : before;
        if (hidden) continue;
        ++pieces_;
        if (gradient_of != nullptr) {
            const std::int64_t segment = batch_.segment[piece];
            if (segment != lit_segment)
                gradient = (*gradient_of)(static_cast<std::size_t>(segment));
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
         part_of(gradient, batch_.from[piece], batch_.to[piece])},
        *lights_, 0.5 * batch_.error_of_length[piece] / transmittance, 0.5 * error_per_opacity_);
    light_ += transmittance * light.value;
    light_error_ += transmittance * light.error;
}

glm::dvec3 RayIntegrator::color() {
    finish_batch();
    return glm::max(color_ + light_,
                    glm::dvec3(0));  // rounding may leave -1e-17 of a colour that fades to 0
}

double RayIntegrator::alpha() const {
    return opacity_from_depth(depth_.value());
}

double RayIntegrator::error_estimate() {
    finish_batch();
    return error_ + light_error_ + hidden();
}

}  // namespace lamina
