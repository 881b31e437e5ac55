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

// Returns the curves with some of their points moved together, as far as they can go without
// passing others, and within the axis; extinctions stay >= 0. Points that are not moved keep their
// numbers, and a moved point those coordinates that are not moved.
TransferCurves moved(const TransferCurves& curves, const std::set<TransferHandle>& points,
                     const TransferShift& shift, const SymlogAxis& axis);

// Returns the curves with all values stretched by `factor` > 0 around `pivot`, and moved by
// `shift`.
TransferCurves windowed(const TransferCurves& curves, double factor, double pivot, double shift);

// Returns the curves with all extinctions times `factor` > 0, limited to the largest finite number.
TransferCurves attenuated(const TransferCurves& curves, double factor);

// Computes the knots of the slope from a point to the next one again.
void follow_slope(std::vector<DensityPoint>& points, std::size_t index);

}  // namespace lamina::view
