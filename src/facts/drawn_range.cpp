// SPDX-License-Identifier: Apache-2.0
#include "facts/drawn_range.h"

#include <cmath>
#include <cstddef>
#include <limits>

#include "mesh/tet_mesh.h"

namespace lamina {

namespace {

// Distance, in widths of the range, to which normalised_sample() moves samples farther away. Moved
// or not, a ray from one into the range is in it for less than 1e-9 of the cell.
constexpr double farthest = 0x1p30;

// Tells whether something visible changes between two neighbouring knots.
bool changes(const TransferKnot& from, const TransferKnot& to) {
    if (from.optics.extinction == 0 && to.optics.extinction == 0) return false;
    return !(from.optics == to.optics);
}

// Returns the values between which something visible changes; empty if nothing does.
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

// Margin on each side of a window, as a share of its width, so that rounding moves no value out.
constexpr double window_margin = 1.0 / 16;

// Share of the mesh's values in the window if all that changes is one step. Less costs time, as
// more tets reach far outside; more costs precision.
constexpr double share_near_step = 0.1;

// Returns the distance from `step` that holds share_near_step of the other values; 0 if none.
double distance_near(double step, std::span<const double> values) {
    std::vector<double> distances;
    distances.reserve(values.size());
    for (const double value : values) {
        const double distance = std::abs(value - step);
        if (std::isfinite(distance) && distance > 0) distances.push_back(distance);
    }
    if (distances.empty()) return 0;
    const auto place =
        static_cast<std::ptrdiff_t>(share_near_step * static_cast<double>(distances.size() - 1));
    std::ranges::nth_element(distances, distances.begin() + place);
    return distances[static_cast<std::size_t>(place)];
}

// Returns the first of three overlapping halves of `range` (lower, middle, upper) that holds
// `inner` with a margin, or else `range`. The margin is not needed at ends of `whole`: no samples
// lie beyond.
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
    // If all samples are equal, they become 0. Dividing by the width, a power of two, is exact.
    if (range.lo == range.hi) {
        const double width = std::max(1.0, std::exp2(std::ceil(std::log2(std::abs(range.lo)))));
        return {range.lo, range.lo + width};
    }
    if (std::ranges::count(transfer_function.knots(), range.hi, &TransferKnot::value) < 2)
        return range;
    const double rounding = 4 * std::numeric_limits<double>::epsilon() * std::abs(range.hi);
    return {range.lo, range.hi + std::max(1e-6 * (range.hi - range.lo), rounding)};
}

// Colours are linear between knots: the largest is at a knot (both sides of a step) or an end.
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

ValueRange mesh_window(const TransferFunction& transfer_function, std::span<const double> values,
                       const ValueRange& range) {
    const ValueRange drawn = drawn_range(transfer_function, range);
    ValueRange inner = changing_range(transfer_function);
    if (inner.empty() || inner.hi < drawn.lo || inner.lo > drawn.hi) return drawn;
    inner = {std::max(inner.lo, drawn.lo), std::min(inner.hi, drawn.hi)};
    // At least 2^-40 of the value: values closer than that hardly differ in double precision.
    const double largest = std::max(std::abs(inner.lo), std::abs(inner.hi));
    double width = std::max(inner.hi - inner.lo, 0x1p-40 * largest);
    if (inner.lo == inner.hi) width = std::max(width, distance_near(inner.lo, values));
    const double margin = inner.lo < inner.hi ? window_margin * width : width;
    const ValueRange window{std::max(inner.lo - margin, drawn.lo),
                            std::min(inner.hi + margin, drawn.hi)};
    return window.lo < window.hi ? window : drawn;
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
    // `least`: float32 values near `inner` are precise enough for this width. If all that changes
    // is one step, it also keeps all samples within `farthest` widths of the step.
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

TetPieces::TetPieces(const TransferFunction& transfer_function, const ValueRange& range) {
    for_each_linear_piece(
        transfer_function.knots(), range.lo, range.hi, [&](const LinearPiece& piece) {
            const bool transparent = piece.at_from.extinction == 0 && piece.at_to.extinction == 0;
            if (transparent && !pieces_.empty() && this->transparent(last())) {
                pieces_.back().to = piece.to;
                pieces_.back().at_to = piece.at_to;
                return;
            }
            pieces_.push_back(piece);
            visible_before_.push_back(visible_before_.back() + (transparent ? 0 : 1));
        });
}

TetPieces::Span TetPieces::met(std::span<const double> scalar, const Tet& tet) const {
    const ValueRange range = range_in(scalar, tet);
    if (range.empty()) return {};
    const auto [lo, hi] = range;
    // The piece with lo is the one before the first that begins above lo. If the scalar varies, the
    // piece with hi is the first that does not end below hi.
    const auto above = std::ranges::upper_bound(pieces_, lo, {}, &LinearPiece::from);
    Span span;
    span.first =
        static_cast<std::int32_t>(std::max<std::ptrdiff_t>(above - pieces_.begin() - 1, 0));
    const auto end = std::ranges::lower_bound(pieces_, hi, {}, &LinearPiece::to);
    const auto last_of_range =
        static_cast<std::int32_t>(std::min<std::ptrdiff_t>(end - pieces_.begin(), last()));
    span.last = lo < hi ? last_of_range : span.first;
    return span;
}

TetPieces::Span TetPieces::visible(std::span<const double> scalar, const Tet& tet) const {
    Span span = met(scalar, tet);
    while (!span.empty() && transparent(span.first)) ++span.first;
    while (!span.empty() && transparent(span.last)) --span.last;
    return span;
}

int TetPieces::count(const Span& span) const {
    if (span.empty()) return 0;
    return visible_before_[static_cast<std::size_t>(span.last) + 1] -
           visible_before_[static_cast<std::size_t>(span.first)];
}

}  // namespace lamina
