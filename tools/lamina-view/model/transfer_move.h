// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>

#include "model/symlog_axis.h"
#include "model/transfer_curves.h"
#include "model/transfer_handle.h"

namespace lamina::view {

// A shift of points: `values` along the scalar, `places` along the axis of extinction.
struct TransferShift {
    double values = 0, places = 0;
};

// The curves with some of their points moved together, as far as they can go without passing
// others, and within the axis; extinctions stay >= 0. Points that are not moved keep their
// numbers, and so does what is not moved of a point.
TransferCurves moved(const TransferCurves& curves, const std::set<TransferHandle>& points,
                     const TransferShift& shift, const SymlogAxis& axis);

// The curves with all values drawn apart by `factor` > 0 around `pivot`, and moved by `shift`.
TransferCurves windowed(const TransferCurves& curves, double factor, double pivot, double shift);

// The curves with all extinctions times `factor` > 0, which are held to the largest finite number.
TransferCurves attenuated(const TransferCurves& curves, double factor);

// Follows the opacity of the way from a point to the next one again.
void follow_slope(std::vector<DensityPoint>& points, std::size_t index);

}  // namespace lamina::view
