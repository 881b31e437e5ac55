// SPDX-License-Identifier: Apache-2.0
// Approximates the depth f(o) = -log1p(-o) of opacity o by chords between (1 - e) f and (1 + e) f.
// Each starts and ends on the lower curve and touches the upper one: longer ones leave the band.
#include "optics/opacity.h"

#include <algorithm>
#include <glm/common.hpp>

#include "base/error.h"

namespace lamina {
namespace {

struct Place {
    double opacity;
    double depth;   // f at this opacity
    double height;  // value of the chords at this opacity
};

// Returns the x >= 0 with x - log1p(x) = d.
double rise_to_touch(double d) {
    const double s = std::sqrt(2 * d);
    double x = s + d * 2 / 3 + s * d / 18;
    if (d < 1e-8) return x;  // the series is good to s^3
    for (int i = 0; i < 6; ++i) x -= (x - std::log1p(x) - d) * (1 + x) / x;
    return x;
}

// A chain of consecutive chords that begins at the opacity `from` and stays within a tolerance.
class Chain {
  public:
    Chain(double from, double tolerance)
        : lower_(1 - tolerance), upper_(1 + tolerance), at_{from, -std::log1p(-from), 0} {
        at_.height = at_.depth;
        aim();
    }

    // Tells whether the chord can end on f here: it lies above f, or has not met the upper curve.
    bool reaches(double opacity, double depth) const {
        return opacity <= touch_ || at_.height + slope_ * (opacity - at_.opacity) >= depth;
    }

    // Ends the current chord on the lower curve, begins the next one there, and returns that place.
    const Place& advance() {
        const double clear = 1 - at_.opacity;
        // v is the next place's 1 - opacity, divided by `clear`. The chord meets the lower curve
        // where height + slope clear (1 - v) = lower (depth - ln v). The difference of both sides
        // is concave in v, so Newton's steps approach the smaller root from below.
        const double offset = at_.height - lower_ * at_.depth, rise = slope_ * clear;
        const auto above = [&](double v) { return offset + rise * (1 - v) + lower_ * std::log(v); };
        double v = lower_ / rise / 2;
        while (above(v) > 0) v /= 2;
        for (int i = 0; i < 40; ++i) {
            const double step = above(v) / (lower_ / v - rise);
            v -= step;
            if (std::abs(step) <= 1e-15 * v) break;
        }
        at_.opacity += clear * (1 - v);
        at_.depth -= std::log(v);
        at_.height = lower_ * at_.depth;
        aim();
        return at_;
    }

  private:
    // Finds the tangent from the current place to the upper curve. It touches at 1 - o = clear / r,
    // where r - 1 - ln r = depth - height / upper.
    void aim() {
        const double x = rise_to_touch(at_.depth - at_.height / upper_), clear = 1 - at_.opacity;
        slope_ = upper_ * (1 + x) / clear;
        touch_ = at_.opacity + clear * x / (1 + x);
    }

    double lower_, upper_;          // factors of f on the two curves
    Place at_;                      // start of the current chord
    double slope_ = 0, touch_ = 0;  // the chord's slope, and the opacity at which it touches
};

// Writes the chords' ends in [from, to). Returns false if there are more than `most` chords.
bool follow(double from, double to, double tolerance, std::size_t most,
            std::vector<Place>& places) {
    places.clear();
    const double depth = -std::log1p(-to);
    Chain chain(from, tolerance);
    while (!chain.reaches(to, depth)) {
        if (places.size() + 1 == most) return false;
        places.push_back(chain.advance());
    }
    return true;
}

// Finds the fewest chords within opacity_slope_tolerance, then nearly their least tolerance.
std::vector<Place> follow_evenly(double from, double to) {
    constexpr std::size_t any = 1000;
    double kept = opacity_slope_tolerance, missed = 0;
    std::vector<Place> best, tried;
    follow(from, to, kept, any, best);
    const std::size_t pieces = best.size() + 1;
    if (pieces == 1) return best;
    for (int halvings = 0; halvings < 12; ++halvings) {
        const double tolerance = (kept + missed) / 2;
        const bool enough = follow(from, to, tolerance, pieces, tried);
        (enough ? kept : missed) = tolerance;
        if (enough) best.swap(tried);
    }
    return best;
}

using Density = GivenPoint::Density;

double extinction_of(const GivenPoint& point, double unit_length) {
    return point.given_as == Density::opacity ? extinction_from_opacity(point.density, unit_length)
                                              : point.density;
}

// Converts points to knots. A point gets two knots if the extinctions on its sides differ.
class KnotBuilder {
  public:
    KnotBuilder(const std::vector<GivenPoint>& points, double unit_length)
        : points_(points), unit_length_(unit_length) {}

    std::vector<TransferKnot> build() {
        for (std::size_t i = 0; i < points_.size(); ++i) {
            if (i > 0) add_between(points_[i - 1], points_[i]);
            add_point(i);
            if (knots_.size() > i + 1 + most_scene_points) {
                fail(
                    "slopes of opacity take more than {} pieces up to point {}, expected fewer "
                    "points",
                    most_scene_points, i);
            }
        }
        return std::move(knots_);
    }

  private:
    // Returns the extinction at a point on the side of its neighbour, or of none if `neighbour` is
    // null: on slopes of opacity it is limited to steepest_optical_depth.
    double at_side(const GivenPoint& point, const GivenPoint* neighbour) const {
        const double extinction = extinction_of(point, unit_length_);
        if (point.given_as != Density::opacity || neighbour == nullptr) return extinction;
        if (neighbour->given_as == Density::opacity && neighbour->density == point.density)
            return extinction;
        return std::min(extinction, steepest_optical_depth / unit_length_);
    }

    // Adds one knot for each of two points at one value (their interval is empty), else one or two.
    void add_point(std::size_t i) {
        const GivenPoint& point = points_[i];
        const GivenPoint* const before = i > 0 ? &points_[i - 1] : nullptr;
        const GivenPoint* const after = i + 1 < points_.size() ? &points_[i + 1] : nullptr;
        const bool ends_step = before != nullptr && before->value == point.value;
        const bool begins_step = after != nullptr && after->value == point.value;
        const double below = at_side(point, before), above = at_side(point, after);
        if (!ends_step) knots_.push_back({point.value, {point.color, below}, point.smooth});
        if (ends_step || (!begins_step && above != below))
            knots_.push_back({point.value, {point.color, above}});
    }

    void add_between(const GivenPoint& a, const GivenPoint& b) {
        if (a.given_as != Density::opacity || b.given_as != Density::opacity) return;
        for (const OpacitySlopeKnot& knot : follow_opacity(a.density, b.density)) {
            const double value = glm::mix(a.value, b.value, knot.share);
            if (!(value > knots_.back().value && value < b.value)) continue;
            knots_.push_back(
                {value,
                 {glm::mix(a.color, b.color, knot.share), knot.optical_depth / unit_length_},
                 knot.optical_depth < steepest_optical_depth});
        }
    }

    const std::vector<GivenPoint>& points_;
    double unit_length_;
    std::vector<TransferKnot> knots_;
};

}  // namespace

std::vector<OpacitySlopeKnot> follow_opacity(double from, double to) {
    const double low = std::min(from, to), high = std::max(from, to);
    const double steepest = -std::expm1(-steepest_optical_depth);
    std::vector<OpacitySlopeKnot> knots;
    if (low >= steepest || low == high) return knots;
    const double top = std::min(high, steepest);
    for (const Place& place : follow_evenly(low, top))
        knots.push_back({(place.opacity - low) / (high - low), place.height});
    if (top < high) knots.push_back({(top - low) / (high - low), steepest_optical_depth});
    if (from < to) return knots;
    std::ranges::reverse(knots);
    for (OpacitySlopeKnot& knot : knots) knot.share = 1 - knot.share;
    return knots;
}

std::vector<TransferKnot> linear_in_extinction(const std::vector<GivenPoint>& points,
                                               double unit_length) {
    std::vector<TransferKnot> knots;
    for (const GivenPoint& point : points)
        knots.push_back(
            {point.value, {point.color, extinction_of(point, unit_length)}, point.smooth});
    return knots;
}

std::vector<TransferKnot> linear_in_opacity(const std::vector<GivenPoint>& points,
                                            double unit_length) {
    return KnotBuilder(points, unit_length).build();
}

TransferFunction TransferFunction::linear_opacity(const std::vector<OpacityKnot>& points,
                                                  double unit_length) {
    if (!(unit_length > 0)) fail("unit_length is {}, expected a number > 0", unit_length);
    std::vector<GivenPoint> given;
    for (const OpacityKnot& point : points) {
        if (!(point.opacity >= 0 && point.opacity <= 1)) {
            fail("point {}: opacity is {}, expected a number from 0 to 1", given.size(),
                 point.opacity);
        }
        given.push_back({point.value, point.color, Density::opacity, point.opacity});
    }
    linear(linear_in_extinction(given, unit_length));  // checks the points as they were given
    return linear(linear_in_opacity(given, unit_length));
}

}  // namespace lamina
