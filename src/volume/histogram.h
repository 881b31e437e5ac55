// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "volume/min_max_bricks.h"

namespace lamina {

// How many values lie in intervals of equal width that follow one another: edges[i] <= value <
// edges[i + 1], and the last interval has its upper edge, too.
struct Histogram {
    static constexpr std::int64_t most_intervals = 256;

    std::vector<double> edges;         // one more than counts, or none
    std::vector<std::int64_t> counts;  // sum: the finite values
    double per_unit = 0;               // intervals per unit of value; 0 where that is no number

    bool empty() const { return counts.empty(); }

    // Cuts a range, which is not empty, into most_intervals, or one where it is a single value.
    static Histogram of_range(const ValueRange& range) {
        const std::int64_t intervals = range.lo < range.hi ? most_intervals : 1;
        Histogram histogram;
        for (std::int64_t i = 0; i <= intervals; ++i) {
            const double share = static_cast<double>(i) / static_cast<double>(intervals);
            // Does not overflow where hi - lo does.
            histogram.edges.push_back((1 - share) * range.lo + share * range.hi);
        }
        histogram.counts.resize(static_cast<std::size_t>(intervals));
        const double per_unit = static_cast<double>(intervals) / (range.hi - range.lo);
        if (std::isfinite(per_unit)) histogram.per_unit = per_unit;
        return histogram;
    }

    // The interval of a value between the first and the last edge: a guess, then exactly by the
    // edges.
    std::size_t place(double value) const {
        const auto last = static_cast<double>(counts.size() - 1);
        const double guess = per_unit > 0 ? per_unit * (value - edges.front()) : 0;
        auto i = static_cast<std::size_t>(std::clamp(guess, 0.0, last));
        while (i > 0 && value < edges[i]) --i;
        while (i + 1 < counts.size() && value >= edges[i + 1]) ++i;
        return i;
    }
};

}  // namespace lamina
