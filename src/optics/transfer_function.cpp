// SPDX-License-Identifier: Apache-2.0
#include "lamina/transfer_function.h"

#include <cmath>
#include <functional>
#include <glm/common.hpp>
#include <limits>
#include <numeric>
#include <optional>
#include <type_traits>
#include <utility>

#include "base/error.h"
#include "optics/pieces.h"

namespace lamina {
namespace {

// Largest magnitude of scalars, so that their differences stay finite.
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

// Tells whether `between` lies on the line from a to b, up to a few roundings.
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

// Tells whether test(a, b) is true for the optics at the ends of every piece that shares more than
// a point with [lo, hi], and test(k, k) for every knot in it and for the constant optics outside
// the knots.
template <typename Test>
bool for_all_parts(std::span<const TransferKnot> knots, double lo, double hi, const Test& test) {
    const auto at = [&](const TransferKnot& knot) { return test(knot.optics, knot.optics); };
    if (lo < knots.front().value && !at(knots.front())) return false;
    const auto inside = std::ranges::lower_bound(knots, lo, {}, &TransferKnot::value);
    auto i = static_cast<std::size_t>(inside - knots.begin());
    for (i -= i > 0 ? 1 : 0; i < knots.size() && knots[i].value <= hi; ++i) {
        const TransferKnot& knot = knots[i];
        if (knot.value >= lo && !at(knot)) return false;
        if (i + 1 < knots.size() && std::max(lo, knot.value) < std::min(hi, knots[i + 1].value) &&
            !test(knot.optics, knots[i + 1].optics))
            return false;
    }
    return hi <= knots.back().value || at(knots.back());
}

// Tells whether key(optics) is constant in [lo, hi], leaving out pieces for which !counts(a, b).
template <typename Key, typename Counts>
bool same_everywhere(std::span<const TransferKnot> knots, double lo, double hi, const Key& key,
                     const Counts& counts) {
    using Value = std::remove_cvref_t<std::invoke_result_t<Key, const OpticalProperties&>>;
    std::optional<Value> seen;
    return for_all_parts(knots, lo, hi,
                         [&](const OpticalProperties& a, const OpticalProperties& b) {
                             if (!counts(a, b)) return true;
                             const Value &at_a = std::invoke(key, a), &at_b = std::invoke(key, b);
                             if (!seen) seen = at_a;
                             return at_a == *seen && at_b == *seen;
                         });
}

constexpr auto always = [](const OpticalProperties&, const OpticalProperties&) { return true; };

// Largest number of pieces that one cubic may replace: bounds the time of the search.
constexpr std::size_t most_merged = 64;
// Largest distance of colours (0..1) from a line that counts as linear: the precision of a float.
constexpr double color_tolerance = 1e-6;

// Largest extinction of curves, because bends must fit into floats; pieces above it stay straight.
constexpr double largest_extinction = 1e30;

using Pieces = std::span<const CurvedPiece>;

// Tells whether the knot at `value` is smooth. A step is not: it has a knot on each side.
bool smooth_at(std::span<const TransferKnot> knots, double value) {
    const auto knot = std::ranges::lower_bound(knots, value, {}, &TransferKnot::value);
    if (knot == knots.end() || knot->value != value) return false;
    const auto next = knot + 1;
    return knot->smooth && (next == knots.end() || next->value != value);
}

bool colors_are_linear(Pieces pieces, const CurvedPiece& all) {
    for (const CurvedPiece& piece : pieces.subspan(1)) {
        const double share = (piece.from - all.from) / (all.to - all.from);
        const glm::dvec3 line = glm::mix(all.at_from.color, all.at_to.color, share);
        for (int c = 0; c < 3; ++c) {
            if (std::abs(line[c] - piece.at_from.color[c]) > color_tolerance) return false;
        }
    }
    return true;
}

// Calls visit(share, extinction) at four places in each piece; share: 0 to 1 along `all`.
template <typename Visit>
void for_each_place(Pieces pieces, const CurvedPiece& all, const Visit& visit) {
    constexpr int places = 4;
    for (const CurvedPiece& piece : pieces) {
        for (int i = 0; i < places; ++i) {
            const double within = static_cast<double>(i) / places;
            const double value = piece.from + (piece.to - piece.from) * within;
            const double extinction =
                glm::mix(piece.at_from.extinction, piece.at_to.extinction, within);
            visit((value - all.from) / (all.to - all.from), extinction);
        }
    }
}

// Returns the cubic with the least squared relative error, if all errors are <= curve_tolerance.
std::optional<CurvedPiece> merged(Pieces pieces) {
    CurvedPiece all{
        {pieces.front().from, pieces.back().to, pieces.front().at_from, pieces.back().at_to}};
    if (std::max(all.at_from.extinction, all.at_to.extinction) > largest_extinction) return {};
    if (!colors_are_linear(pieces, all)) return {};
    const double left = all.at_from.extinction, change = all.at_to.extinction - left;
    double a = 0, b = 0, c = 0, d = 0, e = 0;  // normal equations: [a b; b c] bend = [d e]
    for_each_place(pieces, all, [&](double u, double extinction) {
        if (!(extinction > 0)) return;
        const double p = u * (1 - u) / extinction, q = p * u;
        const double wanted = (extinction - left - change * u) / extinction;
        a += p * p;
        b += p * q;
        c += q * q;
        d += p * wanted;
        e += q * wanted;
    });
    const double determinant = a * c - b * b;
    if (!(determinant > 0)) return {};
    all.bend[0] = (c * d - b * e) / determinant;
    all.bend[1] = (a * e - b * d) / determinant;
    bool near = std::isfinite(all.bend[0]) && std::isfinite(all.bend[1]);
    for_each_place(pieces, all, [&](double u, double extinction) {
        if (u == 0) return;
        const double curve = left + u * (change + (1 - u) * (all.bend[0] + u * all.bend[1]));
        near =
            near && extinction > 0 && std::abs(curve - extinction) <= curve_tolerance * extinction;
    });
    if (near) return all;
    return {};
}

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
    for (std::size_t i = 0; i < knots_.size(); ++i) {
        if (i % block == 0) largest_.push_back(0);
        largest_.back() = std::max(largest_.back(), knots_[i].optics.extinction);
    }
}

TransferFunction TransferFunction::with_codes(std::string labels) const {
    TransferFunction result = *this;
    result.of_codes_ = true;
    result.labels_ = std::move(labels);
    return result;
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
        // Midpoints of close points may round to one number: the plateau has no width.
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
    const auto scaled = [&](double extinction) {
        return std::min(extinction * factor, std::numeric_limits<double>::max());
    };
    TransferFunction result = *this;
    for (TransferKnot& knot : result.knots_)
        knot.optics.extinction = scaled(knot.optics.extinction);
    for (double& largest : result.largest_) largest = scaled(largest);
    return result;
}

double TransferFunction::max_extinction(double lo, double hi) const {
    double largest = std::max(at(lo).extinction, at(hi).extinction);
    // Every brick of a volume asks this, so the search does not visit all knots.
    const auto place = [&](auto knot) { return static_cast<std::size_t>(knot - knots_.begin()); };
    const auto first = std::ranges::lower_bound(knots_, lo, {}, &TransferKnot::value);
    const std::size_t end =
        place(std::ranges::upper_bound(first, knots_.end(), hi, {}, &TransferKnot::value));
    for (std::size_t i = place(first); i < end;) {
        const bool whole = i % block == 0 && i + block <= end;
        largest = std::max(largest, whole ? largest_[i / block] : knots_[i].optics.extinction);
        i += whole ? block : 1;
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

std::vector<CurvedPiece> pieces_between(const TransferFunction& transfer_function, double lo,
                                        double hi, bool curved) {
    std::vector<CurvedPiece> straight;
    const auto knots = transfer_function.knots();
    for_each_linear_piece(knots, lo, hi,
                          [&](const LinearPiece& piece) { straight.push_back({piece}); });
    if (!curved) return straight;
    std::vector<CurvedPiece> pieces;
    for (std::size_t i = 0; i < straight.size();) {
        CurvedPiece piece = straight[i];
        std::size_t count = 1;
        while (i + count < straight.size() && count < most_merged &&
               smooth_at(knots, straight[i + count].from)) {
            const auto longer = merged(Pieces(straight).subspan(i, count + 1));
            if (!longer) break;
            piece = *longer;
            ++count;
        }
        pieces.push_back(piece);
        i += count;
    }
    return pieces;
}

}  // namespace lamina
