// SPDX-License-Identifier: Apache-2.0
#include "reference/ray_integrator.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "optics/opacity.h"
#include "reference/emission_integral.h"
#include "reference/light_integral.h"

namespace lamina {
namespace {

// Early termination may cost this share of the tolerance. The rest of the ray's colour is at most
// its transmittance times the brightest colour.
constexpr double termination_share = 1e-3;

EmissionPiece make_piece(const TransferInterval& interval, const Cubic& scalar, double length) {
    EmissionPiece piece;
    const double inverse = interval.inverse_width;
    piece.position.c[0] = (scalar.c[0] - interval.lo) * inverse;
    piece.extinction.c[0] = interval.extinction(scalar.c[0]) * length;
    for (std::size_t i = 1; i < 4; ++i) {
        piece.position.c[i] = scalar.c[i] * inverse;
        piece.extinction.c[i] = interval.extinction_change * piece.position.c[i] * length;
    }
    return piece;
}

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
RayIntegrator::RayIntegrator(const TransferIntervals& transfer, double tolerance, double ray_length,
                             const RayLights* lights)
    : transfer_(transfer),
      lights_(lights),
      brightest_(std::max(1.0, lights != nullptr ? lights->brightest_lit(transfer.brightest())
                                                 : transfer.brightest())),
      depth_limit_(std::log(brightest_ / (termination_share * tolerance))),
      error_per_opacity_(tolerance / 4),
      error_per_length_(tolerance / 4 / ray_length) {
    batch_.error_of_opacity = error_per_opacity_;
}

void RayIntegrator::add(const Cubic& scalar, const GradientAlong* gradient, double lo, double hi,
                        double length) {
    if (scalar.constant()) {  // on a step as well: there the value itself decides
        return add_piece(transfer_[transfer_.above(scalar.c[0])], scalar, gradient, length);
    }
    const std::size_t interval = transfer_.above(lo);
    if (interval == transfer_.knot_count() || hi <= transfer_.knot(interval))
        return add_piece(transfer_[interval], scalar, gradient, length);
    add_split(scalar, gradient, length);
}

void RayIntegrator::add_split(const Cubic& scalar, const GradientAlong* gradient, double length) {
    const MonotoneParts parts = monotone_parts(scalar);
    for (int i = 0; i < parts.count && !opaque(); ++i) {
        double from = parts.t[i], start = scalar(from);
        const double to = parts.t[i + 1], end = scalar(to);
        std::size_t interval = start <= end ? transfer_.above(start) : transfer_.below(start);
        // Advances piece by piece up to each knot that is crossed, and then to the end of the
        // monotone part.
        const auto advance_to_knot = [&](std::size_t index) {
            const double knot = transfer_.knot(index);
            const double at = knot == start ? from : solve_monotone(scalar, knot, from, to);
            add_part(interval, scalar, gradient, from, at, start, knot, length);
            from = at;
            start = knot;
        };
        if (start <= end) {
            for (; interval < transfer_.knot_count() && transfer_.knot(interval) < end; ++interval)
                advance_to_knot(interval);
        } else {
            for (; interval > 0 && transfer_.knot(interval - 1) > end; --interval)
                advance_to_knot(interval - 1);
        }
        add_part(interval, scalar, gradient, from, to, start, end, length);
    }
}

void RayIntegrator::add_part(std::size_t interval, const Cubic& scalar,
                             const GradientAlong* gradient, double from, double to, double start,
                             double end, double length) {
    if (!(from < to) || transfer_[interval].transparent) return;
    const Cubic part = part_of(scalar, from, to, start, end);
    length *= to - from;
    if (gradient == nullptr) return add_piece(transfer_[interval], part, nullptr, length);
    const GradientAlong of_part = part_of(*gradient, from, to);
    add_piece(transfer_[interval], part, &of_part, length);
}

void RayIntegrator::add_piece(const TransferInterval& interval, const Cubic& scalar,
                              const GradientAlong* gradient, double length) {
    if (interval.transparent || opaque()) return;
    ++pieces_;
    const EmissionPiece piece = make_piece(interval, scalar, length);
    const double depth = std::max(0.0, piece.depth(1));
    intervals_[batch_.count] = &interval;
    batch_.add(piece, depth_.value(), depth, error_per_length_ * length, interval.color_span);
    if (gradient != nullptr) add_light(interval, piece, *gradient, length);
    depth_.add(depth);
    if (batch_.count == EmissionBatch::capacity) finish_batch();
}

void RayIntegrator::finish_batch() {
    integrate_emission(batch_);
    for (std::size_t i = 0; i < batch_.count; ++i) {
        const TransferInterval& interval = *intervals_[i];
        const double transmittance = batch_.transmittance[i];
        color_ += transmittance * batch_.opacity[i] * interval.at_lo.color;
        if (!(transmittance * interval.color_span > 0)) continue;
        color_ += transmittance * batch_.value[i] * interval.color_change;
        error_ += transmittance * interval.color_span * batch_.error[i];
    }
    batch_.count = 0;
}

void RayIntegrator::add_light(const TransferInterval& interval, const EmissionPiece& emission,
                              const GradientAlong& gradient, double length) {
    const double transmittance = std::exp(-depth_.value());
    const LightIntegral light =
        integrate_light({emission, interval.at_lo.color, interval.color_change, gradient}, *lights_,
                        0.5 * error_per_length_ * length / transmittance, 0.5 * error_per_opacity_);
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
