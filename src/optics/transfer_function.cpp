// SPDX-License-Identifier: Apache-2.0
#include "lamina/transfer_function.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <numeric>
#include <optional>
#include <type_traits>

#include "base/error.h"
#include "optics/pieces.h"

namespace lamina {

namespace {

// Limit of scalars, so that their differences stay finite.
constexpr double largest_value = 1e300;

void check_optics(const OpticalProperties& optics, std::size_t index) {
    constexpr const char* channels[] = {"red", "green", "blue"};
    for (int c = 0; c < 3; ++c) {
        if (!std::isfinite(optics.color[c]) || optics.color[c] < 0) {
            fail("point {}: {} is {}, expected a finite number >= 0", index, channels[c],
                 optics.color[c]);
        }
    }
    if (!std::isfinite(optics.extinction) || optics.extinction < 0) {
        fail("point {}: extinction is {}, expected a finite number >= 0", index, optics.extinction);
    }
}

void check(std::span<const TransferKnot> points) {
    if (points.empty()) fail("no points, expected at least one");
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double value = points[i].value;
        if (!(std::abs(value) <= largest_value)) {
            fail("point {}: value is {}, expected a number between -1e300 and 1e300", i, value);
        }
        if (i > 0 && value < points[i - 1].value) {
            fail("point {}: value is {}, expected at least {}, the value of the point before it", i,
                 value, points[i - 1].value);
        }
        if (i > 1 && value == points[i - 2].value) {
            fail("point {}: value is {} for the third time, expected at most two points at a value",
                 i, value);
        }
        check_optics(points[i].optics, i);
    }
}

// Returns whether `between` lies on the straight line from a to b, up to rounding. All terms of
// interpolate() are >= 0, so its results are good to a few roundings.
bool on_line(const TransferKnot& a, const TransferKnot& between, const TransferKnot& b) {
    constexpr double roundings = 8 * std::numeric_limits<double>::epsilon();
    if (!(a.value < between.value && between.value < b.value)) return false;
    const OpticalProperties there = interpolate(a, b, between.value);
    const auto near = [&](double found, double wanted) {
        return std::abs(found - wanted) <= roundings * wanted;
    };
    return near(there.extinction, between.optics.extinction) &&
           near(there.color.r, between.optics.color.r) &&
           near(there.color.g, between.optics.color.g) &&
           near(there.color.b, between.optics.color.b);
}

// Calls visit(a, b) with the ends of every linear piece that shares more than a point with [lo,
// hi], and visit(k, k) for every knot in [lo, hi] and for the constant parts outside the knots.
template <typename Visit>
void for_each_part(std::span<const TransferKnot> knots, double lo, double hi, const Visit& visit) {
    if (lo < knots.front().value) visit(knots.front().optics, knots.front().optics);
    for (std::size_t i = 0; i < knots.size(); ++i) {
        const TransferKnot& knot = knots[i];
        if (knot.value >= lo && knot.value <= hi) visit(knot.optics, knot.optics);
        if (i + 1 < knots.size() && std::max(lo, knot.value) < std::min(hi, knots[i + 1].value)) {
            visit(knot.optics, knots[i + 1].optics);
        }
    }
    if (hi > knots.back().value) visit(knots.back().optics, knots.back().optics);
}

// Returns whether key(part) is the same for all parts that meet [lo, hi] and pass `counts`.
template <typename Key, typename Counts>
bool same_everywhere(std::span<const TransferKnot> knots, double lo, double hi, const Key& key,
                     const Counts& counts) {
    using Value = std::remove_cvref_t<std::invoke_result_t<Key, const OpticalProperties&>>;
    std::optional<Value> seen;
    bool same = true;
    for_each_part(knots, lo, hi, [&](const OpticalProperties& a, const OpticalProperties& b) {
        if (!counts(a, b)) return;
        const Value &at_a = std::invoke(key, a), &at_b = std::invoke(key, b);
        if (!seen) seen = at_a;
        same = same && at_a == *seen && at_b == *seen;
    });
    return same;
}

constexpr auto always = [](const OpticalProperties&, const OpticalProperties&) { return true; };

}  // namespace

TransferFunction::TransferFunction(std::span<const TransferKnot> knots) {
    for (const TransferKnot& knot : knots) {
        if (!knots_.empty() && knots_.back().value == knot.value &&
            knots_.back().optics == knot.optics)
            continue;
        while (knots_.size() > 1 && on_line(knots_[knots_.size() - 2], knots_.back(), knot))
            knots_.pop_back();
        knots_.push_back(knot);
    }
}

TransferFunction TransferFunction::linear(const std::vector<TransferKnot>& points) {
    check(points);
    return TransferFunction(points);
}

TransferFunction TransferFunction::nearest(const std::vector<TransferKnot>& points) {
    check(points);
    std::vector<TransferKnot> knots = {points.front()};
    for (std::size_t i = 1; i < points.size(); ++i) {
        const double step = std::midpoint(points[i - 1].value, points[i].value);
        const bool at_step_before = knots.size() > 1 && knots.back().value == step;
        // Two points may be so close that their midpoints round to one number. The plateau between
        // them then has no width.
        if (at_step_before)
            knots.pop_back();
        else
            knots.push_back({step, points[i - 1].optics});
        knots.push_back({step, points[i].optics});
    }
    if (knots.size() > 1) knots.erase(knots.begin());
    return TransferFunction(knots);
}

OpticalProperties TransferFunction::at(double value) const {
    const auto above = std::upper_bound(
        knots_.begin(), knots_.end(), value,
        [](double scalar, const TransferKnot& knot) { return scalar < knot.value; });
    if (above == knots_.begin()) return knots_.front().optics;
    if (above == knots_.end()) return knots_.back().optics;
    return interpolate(*(above - 1), *above, value);
}

TransferFunction TransferFunction::attenuated(double factor) const {
    TransferFunction result = *this;
    for (TransferKnot& knot : result.knots_) {
        knot.optics.extinction =
            std::min(knot.optics.extinction * factor, std::numeric_limits<double>::max());
    }
    return result;
}

double TransferFunction::max_extinction(double lo, double hi) const {
    double largest = std::max(at(lo).extinction, at(hi).extinction);
    // Every brick of a volume asks this, so the search does not visit all knots.
    for (auto knot = std::ranges::lower_bound(knots_, lo, {}, &TransferKnot::value);
         knot != knots_.end() && knot->value <= hi; ++knot) {
        largest = std::max(largest, knot->optics.extinction);
    }
    return largest;
}

bool TransferFunction::constant(double lo, double hi) const {
    return same_everywhere(knots_, lo, hi, std::identity(), always);
}

bool TransferFunction::constant_extinction(double lo, double hi) const {
    return same_everywhere(knots_, lo, hi, &OpticalProperties::extinction, always);
}

bool TransferFunction::constant_color(double lo, double hi) const {
    return same_everywhere(knots_, lo, hi, &OpticalProperties::color, always);
}

bool TransferFunction::single_color(double lo, double hi) const {
    const auto seen = [](const OpticalProperties& a, const OpticalProperties& b) {
        return a.extinction > 0 || b.extinction > 0;
    };
    return same_everywhere(knots_, lo, hi, &OpticalProperties::color, seen);
}

}  // namespace lamina
