// SPDX-License-Identifier: Apache-2.0
#include "reference/transfer_intervals.h"
#include "simd/lane_set.h"

#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

namespace lamina {
namespace {

// Limits extinctions: this one is opaque over any length; times a length it stays finite.
constexpr double largest_extinction = 1e200;

double largest(const glm::dvec3& v) {
    return std::max({v.x, v.y, v.z});
}

}  // namespace

TransferIntervals::TransferIntervals(const TransferFunction& transfer_function) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const auto knots = transfer_function.knots();
    columns_.knot_count = knots.size();
    columns_.bounds.assign(std::bit_ceil(knots.size() + 1) + 1, infinity);
    columns_.bounds[0] = -infinity;
    add_constant(knots.front());
    for (std::size_t i = 0; i < knots.size(); ++i) {
        columns_.bounds[i + 1] = knots[i].value;
        brightest_ = std::max(brightest_, largest(knots[i].optics.color));
        if (i + 1 < knots.size()) add(knots[i], knots[i + 1]);
    }
    add_constant(knots.back());
    find_visible();
    make_room();
}

void TransferIntervals::add(const TransferKnot& from, const TransferKnot& to) {
    const double extinction = std::min(from.optics.extinction, largest_extinction);
    const IntervalColor color{from.optics.color, to.optics.color - from.optics.color};
    colors_.push_back(color);
    columns_.lo.push_back(from.value);
    columns_.hi.push_back(to.value);
    // No value lies inside a step, so its width does not matter. Others count as >= 1e-300 wide.
    constexpr double largest_inverse = 1e300;
    columns_.inverse_width.push_back(std::min(1 / (to.value - from.value), largest_inverse));
    columns_.extinction.push_back(extinction);
    columns_.extinction_end.push_back(std::min(to.optics.extinction, largest_extinction));
    columns_.extinction_change.push_back(columns_.extinction_end.back() - extinction);
    columns_.color_span.push_back(largest(glm::abs(color.change)));
    columns_.transparent.push_back(from.optics.extinction == 0 && to.optics.extinction == 0);
}

void TransferIntervals::add_constant(const TransferKnot& knot) {
    add(knot, knot);
    columns_.hi.back() = knot.value + 1;
    columns_.inverse_width.back() = 1;
}

void TransferIntervals::make_room() {
    for (std::vector<double>* const column :
         {&columns_.lo, &columns_.hi, &columns_.inverse_width, &columns_.extinction,
          &columns_.extinction_change, &columns_.extinction_end, &columns_.color_span,
          &columns_.transparent}) {
        column->resize(std::max(column->size(), longest_vector));
    }
    columns_.bounds.resize(std::max(columns_.bounds.size(), longest_vector + 1),
                           std::numeric_limits<double>::infinity());
}

void TransferIntervals::find_visible() {
    std::vector<double>&lows = columns_.visible_lo, &highs = columns_.visible_hi;
    for (std::size_t i = 0; i < colors_.size(); ++i) {
        if (columns_.transparent[i] != 0) continue;
        const double lo = columns_.bounds[i], hi = columns_.bounds[i + 1];
        if (!highs.empty() && highs.back() == lo) {
            highs.back() = hi;
        } else {
            lows.push_back(lo);
            highs.push_back(hi);
        }
    }
    columns_.visible_count = lows.size();
    const std::size_t room = std::bit_ceil(lows.size() + 1);
    lows.resize(room, std::numeric_limits<double>::infinity());
    highs.resize(room, std::numeric_limits<double>::infinity());
}

}  // namespace lamina
