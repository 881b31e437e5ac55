// SPDX-License-Identifier: Apache-2.0
// Cuts a ray at layers (exact_pieces, tet_pieces) or at slabs (middle_pieces, run_pieces). Bounds a
// piece by the optics of all scalars that errors of position and scalar can reach
// (optics_between), and by the range of its possible lengths.
#include "selftest/layered_pieces.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

#include "optics/segment_integral.h"
#include "selftest/pixel_bounds.h"

namespace lamina::selftest {
namespace {

struct LayerRun {
    std::size_t layer = 0;
    Interval parameters;  // of the ray
};

// Returns the pieces of a ray in single layers, nearest first, over the interval `part`.
std::vector<LayerRun> runs_between(const LayeredBox& box, const BoxChord& chord,
                                   const Interval& part) {
    const double first_w = chord.w(part.lo), last_w = chord.w(part.hi);
    const std::size_t first = box.layer_at(first_w), last = box.layer_at(last_w);
    std::vector<LayerRun> runs;
    double begin = part.lo;
    for (std::size_t layer = first; layer != last;) {
        const double w = box.layer_begin(last > layer ? layer + 1 : layer);
        const double end = std::clamp((w - chord.start.z) / chord.step.z, begin, part.hi);
        if (end > begin) runs.push_back({layer, {begin, end}});
        begin = end;
        layer += last > layer ? 1 : std::size_t(-1);
    }
    if (part.hi > begin) runs.push_back({last, {begin, part.hi}});
    return runs;
}

struct ExactRun {
    SegmentIntegral integral;
    Interval scalars;
};

ExactRun integrate(const LayeredBox& box, const TransferFunction& transfer_function,
                   const BoxChord& chord, const LayerRun& run) {
    const double front = box.scalar(run.layer, chord.w(run.parameters.lo));
    const double back = box.scalar(run.layer, chord.w(run.parameters.hi));
    return {integrate_segment(transfer_function, front, back,
                              run.parameters.width() * chord.world_per_parameter),
            {std::min(front, back), std::max(front, back)}};
}

PieceBounds exact_piece(const SegmentIntegral& integral) {
    PieceBounds piece;
    piece.depth = {integral.optical_depth, integral.optical_depth};
    for (int c = 0; c < 3; ++c) {
        const double color = integral.alpha > 0 ? integral.color[c] / integral.alpha : 0;
        piece.color[static_cast<std::size_t>(c)] = {color, color};
    }
    return piece;
}

// Returns by how much a mean over an interval of scalars `width` wide changes, as a share of the
// range, if its ends move by `error` each: strips of 2 * error in all enter or leave, whose values
// differ from the mean by at most the range.
double moved_mean_share(double width, double error) {
    const double rest = width - 2 * error;
    return rest > 0 ? std::min(1.0, 2 * error / rest) : 1.0;
}

// Returns the range of optics in an interval of w. `bent`: the method may replace the scalar by a
// line, moved by two thirds of the scalar's deviation from it (Simpson), which is at most its
// range.
OpticsRange optics_between(const LayeredBox& box, const TransferFunction& transfer_function,
                           Interval w, double scalar_error, bool bent = false) {
    w = w.within({0, 1});
    const std::size_t first = box.layer_at(w.lo), last = box.layer_at(w.hi);
    std::optional<Interval> scalars;
    bool has_void = false;
    for (std::size_t layer = first; layer <= last; ++layer) {
        if (box.is_void(layer)) {
            has_void = true;
            continue;
        }
        const double a = box.scalar(layer, std::max(w.lo, box.layer_begin(layer)));
        const double b = box.scalar(layer, std::min(w.hi, box.layer_begin(layer + 1)));
        if (!scalars) scalars = Interval{a, a};
        scalars->include(a);
        scalars->include(b);
    }
    if (!scalars) return {};
    if (bent) scalar_error += 2.0 / 3 * scalars->width();
    OpticsRange met = optics_range(transfer_function, scalars->widened(scalar_error));
    if (has_void) met.extinction.lo = 0;
    return met;
}

// The chord of a ray in the box: exact, and the longest and the shortest that rounding allows.
struct UncertainChord {
    std::optional<BoxChord> exact, widest, narrowest;

    UncertainChord(const LayeredBox& box, const View::Ray& ray, double position)
        : exact(box_chord(box, ray, 0)),
          widest(box_chord(box, ray, position)),
          narrowest(box_chord(box, ray, -position)) {}

    // Returns the range of possible world lengths inside a slab.
    Interval length_in(const Interval& slab) const {
        const auto overlap = [&](const std::optional<BoxChord>& chord) {
            if (!chord) return 0.0;
            const double begin = std::max(slab.lo, chord->parameters.lo);
            const double end = std::min(slab.hi, chord->parameters.hi);
            return std::max(0.0, end - begin) * chord->world_per_parameter;
        };
        return {overlap(narrowest), overlap(widest)};
    }
};

// Calls visit(chord, part, lengths) for every slab that the ray may meet. `part`: the chord's part
// in the slab. `lengths`: its possible world lengths.
template <typename Visit>
void for_each_slab(const UncertainChord& chord, const Slabs& slabs, const Visit& visit) {
    if (!chord.widest) return;
    const BoxChord& any = chord.exact ? *chord.exact : *chord.widest;
    const auto slab_at = [&](double depth) {
        return std::clamp(std::floor((depth - slabs.near) / slabs.thickness), 0.0,
                          slabs.count - 1.0);
    };
    const auto last = static_cast<int>(slab_at(chord.widest->parameters.hi));
    for (auto k = static_cast<int>(slab_at(chord.widest->parameters.lo)); k <= last; ++k) {
        const Interval slab{slabs.near + k * slabs.thickness,
                            slabs.near + (k + 1) * slabs.thickness};
        const Interval lengths = chord.length_in(slab);
        if (!(lengths.hi > 0)) continue;
        visit(any, slab.within(any.parameters), lengths);
    }
}

Interval times(const Interval& extinction, const Interval& length, double relative) {
    return {extinction.lo * length.lo * (1 - relative), extinction.hi * length.hi * (1 + relative)};
}

}  // namespace

std::vector<PieceBounds> exact_pieces(const LayeredBox& box,
                                      const TransferFunction& transfer_function,
                                      const View::Ray& ray) {
    std::vector<PieceBounds> pieces;
    const auto chord = box_chord(box, ray, 0);
    if (!chord) return pieces;
    for (const LayerRun& run : runs_between(box, *chord, chord->parameters)) {
        if (box.is_void(run.layer)) continue;
        pieces.push_back(exact_piece(integrate(box, transfer_function, *chord, run).integral));
    }
    return pieces;
}

Slabs slabs_of(const LayeredBox& box, const View& view, int count) {
    Interval depths{1e300, -1e300};
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 at = box.world({corner & 1, corner >> 1 & 1, corner >> 2});
        depths.include(glm::dot(at - view.eye, view.forward));
    }
    depths.lo = std::max(depths.lo, 0.0);
    return {depths.lo, depths.width() / count, count};
}

std::vector<PieceBounds> middle_pieces(const LayeredBox& box,
                                       const TransferFunction& transfer_function,
                                       const View::Ray& ray, const Slabs& slabs,
                                       const Precision& precision) {
    const UncertainChord chord(box, ray, precision.position);
    const double scalar_error = precision.scalar * box.range().width();
    std::vector<PieceBounds> pieces;
    for_each_slab(chord, slabs, [&](const BoxChord& any, const Interval& part, Interval lengths) {
        const double end_error = precision.slab * slabs.thickness * slabs.count;
        const double middle = any.w(0.5 * (part.lo + part.hi));
        const double moved =
            (0.5 * lengths.width() / any.world_per_parameter + end_error) * std::abs(any.step.z);
        const double off = precision.position + moved;
        const OpticsRange shown = optics_between(
            box, transfer_function, Interval{middle, middle}.widened(off), scalar_error);
        pieces.push_back({times(shown.extinction, lengths, precision.relative), shown.color});
        // If the plane between two slabs is off, one of them gets a part of the other.
        const double half = 0.5 * part.width() * std::abs(any.step.z);
        const OpticsRange met = optics_between(
            box, transfer_function, Interval{middle, middle}.widened(half + off), scalar_error);
        const double exchanged = met.extinction.width() * end_error * any.world_per_parameter;
        pieces.back().depth = pieces.back().depth.widened(exchanged);
        pieces.back().depth.lo = std::max(0.0, pieces.back().depth.lo);
    });
    return pieces;
}

std::vector<PieceBounds> run_pieces(const LayeredBox& box,
                                    const TransferFunction& transfer_function, const View::Ray& ray,
                                    const Slabs& slabs, const Precision& precision) {
    const UncertainChord chord(box, ray, precision.position);
    std::vector<PieceBounds> pieces;
    for_each_slab(chord, slabs, [&](const BoxChord& any, const Interval& part, Interval lengths) {
        const double a = any.w(part.lo), b = any.w(part.hi);
        const Interval w = Interval{std::min(a, b), std::max(a, b)}.widened(precision.position);
        const std::vector<LayerRun> runs = runs_between(box, any, part);
        const double scalar_error = precision.scalar * box.range().width();
        const bool linear = runs.size() == 1;
        const OpticsRange met = optics_between(box, transfer_function, w, scalar_error, !linear);
        if (!linear || box.is_void(runs.front().layer)) {
            pieces.push_back({times(met.extinction, lengths, precision.relative), met.color});
            return;
        }
        const LayerRun& run = runs.front();
        const ExactRun exact = integrate(box, transfer_function, any, run);
        const double length = part.width() * any.world_per_parameter;
        const double mean = length > 0 ? exact.integral.optical_depth / length : 0;
        const double per_w = std::abs(box.scalar(run.layer, box.layer_begin(run.layer + 1)) -
                                      box.scalar(run.layer, box.layer_begin(run.layer))) *
                             static_cast<double>(box.layers());
        const double end_error = scalar_error + per_w * precision.position;
        const double share = moved_mean_share(exact.scalars.width(), end_error);
        const Interval extinction = Interval{mean - share * (mean - met.extinction.lo),
                                             mean + share * (met.extinction.hi - mean)}
                                        .widened(precision.relative * met.extinction.hi);
        pieces.push_back({times(extinction, lengths, precision.relative), met.color});
    });
    return pieces;
}

std::vector<PieceBounds> tet_pieces(const LayeredBox& box,
                                    const TransferFunction& transfer_function, const View::Ray& ray,
                                    double length_error, const Precision& precision) {
    std::vector<PieceBounds> pieces;
    auto chord = box_chord(box, ray, 0);
    const bool certain = chord.has_value();
    if (!certain) chord = box_chord(box, ray, precision.face);
    if (!chord) return pieces;
    for (const LayerRun& run : runs_between(box, *chord, chord->parameters)) {
        if (box.is_void(run.layer)) continue;
        const ExactRun exact = integrate(box, transfer_function, *chord, run);
        const double edge = box.scalar(run.layer, box.layer_begin(run.layer + 1)) -
                            box.scalar(run.layer, box.layer_begin(run.layer));
        const double end_error = precision.scalar * std::abs(edge);
        const OpticsRange met = optics_range(transfer_function, exact.scalars.widened(end_error));
        const double share = moved_mean_share(exact.scalars.width(), end_error);
        const double length = run.parameters.width() * chord->world_per_parameter;
        const double error = met.extinction.width() * share * length +
                             met.extinction.hi * length_error +
                             precision.relative * exact.integral.optical_depth;
        PieceBounds piece = exact_piece(exact.integral);
        piece.depth = {certain ? std::max(0.0, piece.depth.lo - error) : 0, piece.depth.hi + error};
        // The weights of the piece's colours are as uncertain as its optical depth.
        const double color_share = std::min(1.0, precision.color + 2 * share + error);
        for (std::size_t c = 0; c < 3; ++c) {
            const double by =
                color_share * met.color[c].width() + precision.relative * met.color[c].hi;
            piece.color[c] = piece.color[c].widened(by);
        }
        pieces.push_back(piece);
    }
    return pieces;
}

// With gradient g, unit normal n and smallest gradient s, the weight w is g^2 / (g^2 + s^2). The
// factor is 1 - w + w (ambient + diffuse * the sum of |n . l| times colour over the lights l).
OneGradientLight::OneGradientLight(const Lighting& lighting, const LayeredBox& box,
                                   const View::Ray& ray) {
    const glm::dvec3& edge = box.edges[2];
    const double slope = (box.samples.at(1) - box.samples.at(0)) *
                         static_cast<double>(box.layers()) / glm::length(edge);
    const double ratio = *lighting.smallest_gradient / std::abs(slope);
    const double weight = 1 / (1 + ratio * ratio);
    const glm::dvec3 along = glm::normalize(edge), to_eye = -glm::normalize(ray.direction);
    glm::dvec3 light(lighting.ambient);
    terms_ = 1 + lighting.ambient;
    for (const Light& each : lighting.lights) {
        const glm::dvec3 to_light = each.direction ? glm::normalize(*each.direction) : to_eye;
        const glm::dvec3 sum = to_light + to_eye;
        const double size = glm::length(sum);
        const double shine = size > 1e-6 ? std::abs(glm::dot(along, sum)) / size : 0;
        light += lighting.diffuse * std::abs(glm::dot(along, to_light)) * each.color;
        highlight_ += weight * lighting.specular * std::pow(shine, lighting.power) * each.color;
        terms_ += (lighting.diffuse + lighting.power * lighting.specular) *
                  std::max({each.color.x, each.color.y, each.color.z});
    }
    factor_ = 1 - weight + weight * light;
}

void OneGradientLight::shine_on(std::array<double, 4>& pixel) const {
    for (int c = 0; c < 3; ++c) {
        double& channel = pixel[static_cast<std::size_t>(c)];
        channel = factor_[c] * channel + highlight_[c] * pixel[3];
    }
}

void OneGradientLight::shine_on(PixelBounds& pixel, double error) const {
    const double off = error * terms_;
    for (int c = 0; c < 3; ++c) {
        Interval& channel = pixel[static_cast<std::size_t>(c)];
        channel = {std::max(factor_[c] - off, 0.0) * channel.lo +
                       std::max(highlight_[c] - off, 0.0) * pixel[3].lo,
                   (factor_[c] + off) * channel.hi + (highlight_[c] + off) * pixel[3].hi};
    }
}

}  // namespace lamina::selftest
