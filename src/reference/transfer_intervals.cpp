// SPDX-License-Identifier: Apache-2.0
#include "reference/transfer_intervals.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
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
    // No value lies between the knots of a step. Of other knots the nearest are told apart as if
    // they were 1e-300 apart, so that nothing becomes infinite.
    constexpr double largest_inverse = 1e300;
    interval.inverse_width = std::min(1 / (b.value - a.value), largest_inverse);
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
    interval.hi = interval.lo + 1;
    interval.inverse_width = 1;
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
    make_columns();
}

void TransferIntervals::make_columns() {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    columns_.knot_count = knots_.size();
    columns_.bounds.assign(std::bit_ceil(knots_.size() + 1) + 1, infinity);
    columns_.bounds[0] = -infinity;
    std::ranges::copy(knots_, columns_.bounds.begin() + 1);
    for (const TransferInterval& interval : intervals_) {
        columns_.lo.push_back(interval.lo);
        columns_.hi.push_back(interval.hi);
        columns_.inverse_width.push_back(interval.inverse_width);
        columns_.extinction.push_back(interval.at_lo.extinction);
        columns_.extinction_change.push_back(interval.extinction_change);
        columns_.color_span.push_back(interval.color_span);
        columns_.transparent.push_back(interval.transparent ? 1 : 0);
    }
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

}  // namespace lamina
