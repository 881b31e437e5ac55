// SPDX-License-Identifier: Apache-2.0
#include "choice/changed_transfer.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "base/error.h"

namespace lamina {
namespace {

// A linear map that keeps the order of values and hits both ends exactly.
class Stretch {
  public:
    Stretch(double from_lo, double from_hi, const ValueRange& to)
        : lo_(from_lo), width_(from_hi - from_lo), to_(to) {}
    double operator()(double value) const {
        const double place = (value - lo_) / width_;
        return place == 1 ? to_.hi : std::min(to_.lo + (to_.hi - to_.lo) * place, to_.hi);
    }

  private:
    double lo_, width_;
    ValueRange to_;
};

}  // namespace

TransferFunction stretched(const TransferFunction& transfer_function, const ValueRange& range) {
    std::vector<TransferKnot> knots(transfer_function.knots().begin(),
                                    transfer_function.knots().end());
    if (knots.front().value == knots.back().value)
        fail(
            "transfer function: has a single value, {}, expected two that a range could lie "
            "between",
            knots.front().value);
    const Stretch stretch(knots.front().value, knots.back().value, range);
    for (TransferKnot& knot : knots) knot.value = stretch(knot.value);
    for (std::size_t i = 2; i < knots.size(); ++i) {
        if (knots[i].value == knots[i - 2].value) {
            fail("range from {} to {}: is too narrow for the {} points of the transfer function",
                 range.lo, range.hi, knots.size());
        }
    }
    return TransferFunction::linear(knots);
}

TransferFunction recolored(const TransferFunction& transfer_function, Colormap colormap) {
    const auto knots = transfer_function.knots();
    const double from = colormap.colors.front().value, to = colormap.colors.back().value;
    const double lo = knots.front().value, hi = knots.back().value;
    if (lo == hi) {
        const auto colors = TransferFunction::linear(combine(colormap, {{from, 0}}));
        const glm::dvec3 middle = colors.at(from + (to - from) / 2).color;
        return TransferFunction::linear({{lo, {middle, knots.front().optics.extinction}}});
    }
    std::vector<ExtinctionPoint> extinctions;
    for (const TransferKnot& knot : knots)
        extinctions.push_back({knot.value, knot.optics.extinction, knot.smooth});
    if (from < to && !colormap.own_range) stretch(colormap, lo, hi);
    return TransferFunction::linear(combine(colormap, extinctions));
}

}  // namespace lamina
