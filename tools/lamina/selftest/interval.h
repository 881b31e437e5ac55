// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

namespace lamina::selftest {

// A number that lies in [lo, hi].
struct Interval {
    double lo = 0, hi = 0;

    double width() const { return hi - lo; }
    void include(double value) {
        lo = std::min(lo, value);
        hi = std::max(hi, value);
    }
    void include(const Interval& other) {
        lo = std::min(lo, other.lo);
        hi = std::max(hi, other.hi);
    }
    Interval widened(double by) const { return {lo - by, hi + by}; }
    Interval within(const Interval& limits) const {
        return {std::clamp(lo, limits.lo, limits.hi), std::clamp(hi, limits.lo, limits.hi)};
    }
};

}  // namespace lamina::selftest
