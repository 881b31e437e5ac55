// SPDX-License-Identifier: Apache-2.0
#include "facts/drawn_range.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lamina {
namespace {

// Samples farther away, in widths of the range, are moved here. Between such a sample and one in
// the range, a ray is in the range for less than 1e-9 of the cell in either case.
constexpr double farthest = 0x1p30;

bool changes(const TransferKnot& from, const TransferKnot& to) {
    if (from.optics.extinction == 0 && to.optics.extinction == 0) return false;
    return !(from.optics == to.optics);
}

// The values between which something visible changes; empty where nothing does.
ValueRange changing_range(const TransferFunction& transfer_function) {
    const auto knots = transfer_function.knots();
    ValueRange found;
    for (std::size_t i = 1; i < knots.size(); ++i) {
        if (!changes(knots[i - 1], knots[i])) continue;
        if (found.empty()) found.lo = knots[i - 1].value;
        found.hi = knots[i].value;
    }
    return found;
}

// The first of three halves of `range`, side by side and overlapping, that holds `inner` well
// inside, or to an end of `whole`, beyond which there are no samples; else `range`.
ValueRange half_around(const ValueRange& range, const ValueRange& inner, const ValueRange& whole) {
    const double width = (range.hi - range.lo) / 2, margin = width / 16;
    for (const double part : {0.0, 0.5, 1.0}) {
        const double lo = range.lo + part * width, hi = lo + width;
        if ((lo == whole.lo || inner.lo - margin > lo) &&
            (hi == whole.hi || inner.hi + margin < hi))
            return {lo, hi};
    }
    return range;
}

}  // namespace

ValueRange drawn_range(const TransferFunction& transfer_function, const ValueRange& range) {
    if (range.lo == range.hi) return {range.lo, range.lo + std::max(1.0, std::abs(range.lo))};
    if (std::ranges::count(transfer_function.knots(), range.hi, &TransferKnot::value) < 2)
        return range;
    const double rounding = 4 * std::numeric_limits<double>::epsilon() * std::abs(range.hi);
    return {range.lo, range.hi + std::max(1e-6 * (range.hi - range.lo), rounding)};
}

// Colour is linear between knots: its extremes are at knots, both sides of steps, and at the ends
// of the range.
double largest_color(const TransferFunction& transfer_function, const ValueRange& range) {
    double largest = 0;
    const auto include = [&](const glm::dvec3& color) {
        largest = std::max({largest, color.r, color.g, color.b});
    };
    include(transfer_function.at(range.lo).color);
    include(transfer_function.at(range.hi).color);
    for (const TransferKnot& knot : transfer_function.knots()) {
        if (knot.value >= range.lo && knot.value <= range.hi) include(knot.optics.color);
    }
    return largest;
}

float normalised_sample(double value, const ValueRange& range) {
    if (!std::isfinite(value)) return std::numeric_limits<float>::quiet_NaN();
    const double scale = range.hi > range.lo ? 1 / (range.hi - range.lo) : 0;
    return static_cast<float>(std::clamp((value - range.lo) * scale, -farthest, farthest));
}

ValueRange exact_range(const TransferFunction& transfer_function, const ValueRange& range,
                       SampleType type) {
    const ValueRange drawn = drawn_range(transfer_function, range);
    const ValueRange inner = changing_range(transfer_function);
    const bool whole_numbers = type != SampleType::float32;
    const double lo = whole_numbers ? std::floor(drawn.lo) : drawn.lo;
    const ValueRange whole{lo, lo + std::exp2(std::ceil(std::log2(drawn.hi - lo)))};
    if (inner.empty()) return whole;
    ValueRange found = whole;
    // Floats near a value have digits enough at this width. A step alone, at 0 say, has no width of
    // its own: no sample may be too far from it (`farthest`).
    const double largest = std::max(std::abs(inner.lo), std::abs(inner.hi));
    const double narrowest = inner.lo < inner.hi ? 0x1p-120 : 0x1p-28 * (whole.hi - whole.lo);
    const double least = whole_numbers ? 4 : std::max(0x1p-10 * largest, narrowest);
    while (found.hi - found.lo > least) {
        const ValueRange half = half_around(found, inner, whole);
        if (half == found) break;
        found = half;
    }
    return found;
}

}  // namespace lamina
