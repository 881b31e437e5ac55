// SPDX-License-Identifier: Apache-2.0
#include "reference/transfer_intervals.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

namespace lamina {
namespace {

// This extinction is opaque over any length, and its products with lengths stay finite.
constexpr double largest_extinction = 1e200;

double largest(const glm::dvec3& v) {
    return std::max({v.x, v.y, v.z});
}

TransferInterval between(const TransferKnot& a, const TransferKnot& b) {
    TransferInterval interval;
    interval.lo = a.value;
    interval.hi = b.value;
    interval.width = b.value - a.value;
    interval.at_lo = a.optics;
    interval.at_lo.extinction = std::min(a.optics.extinction, largest_extinction);
    interval.color_change = b.optics.color - a.optics.color;
    interval.extinction_change =
        std::min(b.optics.extinction, largest_extinction) - interval.at_lo.extinction;
    interval.color_span = largest(glm::abs(interval.color_change));
    interval.transparent = a.optics.extinction == 0 && b.optics.extinction == 0;
    return interval;
}

TransferInterval outside(const TransferKnot& knot) {
    TransferInterval interval = between(knot, knot);
    interval.hi = interval.lo + (interval.width = 1);
    return interval;
}

}  // namespace

TransferIntervals::TransferIntervals(const TransferFunction& transfer_function) {
    const auto knots = transfer_function.knots();
    intervals_.push_back(outside(knots.front()));
    for (std::size_t i = 0; i < knots.size(); ++i) {
        knots_.push_back(knots[i].value);
        brightest_ = std::max(brightest_, largest(knots[i].optics.color));
        intervals_.push_back(i + 1 < knots.size() ? between(knots[i], knots[i + 1])
                                                  : outside(knots[i]));
    }
    find_visible();
}

void TransferIntervals::find_visible() {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < intervals_.size(); ++i) {
        if (intervals_[i].transparent) continue;
        const double lo = i == 0 ? -infinity : knots_[i - 1];
        const double hi = i == knots_.size() ? infinity : knots_[i];
        if (!visible_.empty() && visible_.back().hi == lo) {
            visible_.back().hi = hi;
        } else {
            visible_.push_back({lo, hi});
        }
    }
}

std::size_t TransferIntervals::above(double value) const {
    return static_cast<std::size_t>(std::upper_bound(knots_.begin(), knots_.end(), value) -
                                    knots_.begin());
}

std::size_t TransferIntervals::below(double value) const {
    return static_cast<std::size_t>(std::lower_bound(knots_.begin(), knots_.end(), value) -
                                    knots_.begin());
}

bool TransferIntervals::visible(double lo, double hi) const {
    const auto range = std::lower_bound(visible_.begin(), visible_.end(), lo,
                                        [](const Range& r, double value) { return r.hi < value; });
    return range != visible_.end() && range->lo <= hi;
}

}  // namespace lamina
