// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "image/coded_image.h"
#include "lamina/volume.h"
#include "volume/min_max_bricks.h"
#include "volume/volume_data.h"

namespace lamina {

// Counts of values in equal intervals: edges[i] <= value < edges[i + 1], or <= in the last.
struct Histogram {
    static constexpr std::int64_t most_intervals = 256;

    std::vector<double> edges;         // one more than counts, or none
    std::vector<std::int64_t> counts;  // their sum is the number of finite values
    double per_unit = 0;               // intervals per unit of value; 0 if that overflows

    bool empty() const { return counts.empty(); }

    // Cuts a range, not empty, into most_intervals, or into one if it is a single value.
    static Histogram of_range(const ValueRange& range) {
        const std::int64_t intervals = range.lo < range.hi ? most_intervals : 1;
        Histogram histogram;
        for (std::int64_t i = 0; i <= intervals; ++i) {
            const double share = static_cast<double>(i) / static_cast<double>(intervals);
            // This form does not overflow, even if hi - lo does.
            histogram.edges.push_back((1 - share) * range.lo + share * range.hi);
        }
        histogram.counts.resize(static_cast<std::size_t>(intervals));
        const double per_unit = static_cast<double>(intervals) / (range.hi - range.lo);
        if (std::isfinite(per_unit)) histogram.per_unit = per_unit;
        return histogram;
    }

    // Returns the index of a value's interval: a guess by scaling, then corrected by the edges.
    std::size_t place(double value) const {
        const auto last = static_cast<double>(counts.size() - 1);
        const double guess = per_unit > 0 ? per_unit * (value - edges.front()) : 0;
        auto i = static_cast<std::size_t>(std::clamp(guess, 0.0, last));
        while (i > 0 && value < edges[i]) --i;
        while (i + 1 < counts.size() && value >= edges[i + 1]) ++i;
        return i;
    }
};

// The distribution of the finite values of data.
struct ValueStatistics {
    // The percentiles that are measured, in thousandths: 500 is the median.
    static constexpr std::array<int, 9> places{1, 10, 50, 250, 500, 750, 950, 990, 999};

    std::int64_t count = 0;           // finite values
    std::vector<double> percentiles;  // one a place; none if there is no value
    Histogram histogram;              // empty if there is no value

    // Returns the rank of a percentile, from 1 in ascending order. The percentile is the smallest
    // value that at least this share of the values does not exceed.
    static std::int64_t rank(int thousandths, std::int64_t count) {
        const std::int64_t rounded_up =
            (thousandths * (count / 1000)) + (thousandths * (count % 1000) + 999) / 1000;
        return rounded_up > 0 ? rounded_up : 1;
    }
};

// Measures exactly: samples of 8 and 16 bits in one parallel pass, with whole numbers as the
// histogram's edges, equally many in each interval; float32 in two passes, with 4 MiB a thread.
ValueStatistics measure_values(const VolumeData& data);

// Measures exactly, with as much memory as the values take.
ValueStatistics measure_values(std::span<const double> values);

// Draws the histogram on white: a bar for each interval, as high as the logarithm of 1 + its count,
// the range of values below, and marks at the median and the outermost percentiles. `width`: 200
// pixels or more. An empty histogram is a line that says so.
CodedImage histogram_picture(const ValueStatistics& statistics, int width);

}  // namespace lamina
