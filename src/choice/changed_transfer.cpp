// SPDX-License-Identifier: Apache-2.0
#include "choice/changed_transfer.h"

#include <vector>

#include "base/error.h"

namespace lamina {
namespace {

// A straight line that leads both ends exactly to theirs.
class Stretch {
  public:
    Stretch(double from_lo, double from_hi, const ValueRange& to)
        : lo_(from_lo), width_(from_hi - from_lo), to_(to) {}
    double operator()(double value) const {
        const double place = (value - lo_) / width_;
        return to_.lo * (1 - place) + to_.hi * place;
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
        extinctions.push_back({knot.value, knot.optics.extinction});
    if (from < to && !colormap.own_range) stretch(colormap, lo, hi);
    return TransferFunction::linear(combine(colormap, extinctions));
}

}  // namespace lamina
