// SPDX-License-Identifier: Apache-2.0
#include "reference/transfer_intervals.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
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
    count_knots_below();
}

void TransferIntervals::count_knots_below() {
    const double first = knots_.front(), range = knots_.back() - first;
    const std::size_t bins = 8 * knots_.size();
    bins_per_unit_ = static_cast<double>(bins) / range;
    if (!std::isfinite(bins_per_unit_) || !(bins_per_unit_ > 0)) bins_per_unit_ = 0;
    // Roundings may put a value into the bin beside its own.
    for (std::size_t bin = 0; bins_per_unit_ > 0 && bin <= bins; ++bin) {
        const double begin = first + (static_cast<double>(bin) - 1) / bins_per_unit_;
        const auto at = std::ranges::lower_bound(knots_, begin);
        knots_below_.push_back(static_cast<std::uint32_t>(at - knots_.begin()));
    }
}

std::size_t TransferIntervals::knots_surely_below(double value) const {
    const double bin = (value - knots_.front()) * bins_per_unit_;
    if (!(bin >= 1)) return 0;
    return knots_below_[std::min(static_cast<std::size_t>(std::min(bin, 1e9)),
                                 knots_below_.size() - 1)];
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

// The first knot that is `beyond` the value: mostly one of the next few in the value's bin.
template <typename Beyond>
std::size_t TransferIntervals::first_knot(double value, const Beyond& beyond) const {
    constexpr std::size_t next_few = 4;
    std::size_t knot = knots_surely_below(value);
    for (std::size_t i = 0; i < next_few; ++i, ++knot)
        if (knot == knots_.size() || beyond(knots_[knot])) return knot;
    return static_cast<std::size_t>(
        std::partition_point(knots_.begin() + static_cast<std::ptrdiff_t>(knot), knots_.end(),
                             std::not_fn(beyond)) -
        knots_.begin());
}

std::size_t TransferIntervals::above(double value) const {
    return first_knot(value, [&](double knot) { return knot > value; });
}

std::size_t TransferIntervals::below(double value) const {
    return first_knot(value, [&](double knot) { return knot >= value; });
}

bool TransferIntervals::visible(double lo, double hi) const {
    const auto range = std::lower_bound(visible_.begin(), visible_.end(), lo,
                                        [](const Range& r, double value) { return r.hi < value; });
    return range != visible_.end() && range->lo <= hi;
}

}  // namespace lamina
