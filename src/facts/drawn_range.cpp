// SPDX-License-Identifier: Apache-2.0
#include "facts/drawn_range.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lamina {

ValueRange drawn_range(const TransferFunction& transfer_function, const ValueRange& range) {
    if (range.lo == range.hi) return {range.lo, range.lo + std::max(1.0, std::abs(range.lo))};
    if (std::ranges::count(transfer_function.knots(), range.hi, &TransferKnot::value) < 2)
        return range;
    const double rounding = 4 * std::numeric_limits<double>::epsilon() * std::abs(range.hi);
    return {range.lo, range.hi + std::max(1e-6 * (range.hi - range.lo), rounding)};
}

}  // namespace lamina
