// SPDX-License-Identifier: Apache-2.0
#include "selftest/optics_range.h"

namespace lamina::selftest {
namespace {

OpticsRange point(const OpticalProperties& optics) {
    OpticsRange range;
    range.extinction = {optics.extinction, optics.extinction};
    for (int c = 0; c < 3; ++c)
        range.color[static_cast<std::size_t>(c)] = {optics.color[c], optics.color[c]};
    return range;
}

}  // namespace

void OpticsRange::include(const OpticsRange& other) {
    extinction.include(other.extinction);
    for (std::size_t c = 0; c < 3; ++c) color[c].include(other.color[c]);
}

OpticsRange optics_range(const TransferFunction& transfer_function, const Interval& scalars) {
    // Optics are linear between knots, so the extremes lie at the ends and at the knots between.
    OpticsRange range = point(transfer_function.at(scalars.lo));
    range.include(point(transfer_function.at(scalars.hi)));
    for (const TransferKnot& knot : transfer_function.knots()) {
        if (knot.value >= scalars.lo && knot.value <= scalars.hi) range.include(point(knot.optics));
    }
    return range;
}

}  // namespace lamina::selftest
