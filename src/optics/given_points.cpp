// SPDX-License-Identifier: Apache-2.0
#include "optics/given_points.h"

#include <glm/common.hpp>

#include <algorithm>

#include "base/error.h"
#include "optics/opacity.h"
#include "optics/opacity_slope.h"

namespace lamina {
namespace {

using Density = GivenPoint::Density;

double extinction_of(const GivenPoint& point, double unit_length) {
    return point.given_as == Density::opacity ? extinction_from_opacity(point.density, unit_length)
                                              : point.density;
}

// Builds the knots from the first point to the last. A point gets two knots if the extinctions on
// its sides differ.
class KnotBuilder {
  public:
    KnotBuilder(const std::vector<GivenPoint>& points, double unit_length)
        : points_(points), unit_length_(unit_length) {}

    std::vector<TransferKnot> build() {
        for (std::size_t i = 0; i < points_.size(); ++i) {
            if (i > 0) add_between(points_[i - 1], points_[i]);
            add_point(i);
            if (knots_.size() > most_scene_points) {
                fail(
                    "slopes of opacity take more than {} pieces up to point {}, expected fewer "
                    "points",
                    most_scene_points, i);
            }
        }
        return std::move(knots_);
    }

  private:
    // Returns the extinction at a point on the side of its neighbour, which may be null.
    double at_side(const GivenPoint& point, const GivenPoint* neighbour) const {
        const double extinction = extinction_of(point, unit_length_);
        if (point.given_as != Density::opacity || neighbour == nullptr) return extinction;
        if (neighbour->given_as == Density::opacity && neighbour->density == point.density)
            return extinction;
        return std::min(extinction, steepest_optical_depth / unit_length_);
    }

    // Two points at one value have one side each: the interval between them has no width.
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

    // Adds the knots inside the slope of opacity between two points.
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
