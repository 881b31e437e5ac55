// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "lamina/volume.h"
#include "volume/histogram.h"
#include "volume/volume_data.h"

namespace lamina {

// How the finite values of data are spread.
struct ValueStatistics {
    // Of the percentiles, in thousandths of the values.
    static constexpr std::array<int, 9> places{1, 10, 50, 250, 500, 750, 950, 990, 999};

    std::int64_t count = 0;           // finite values
    std::vector<double> percentiles;  // one a place; none where there is no value
    Histogram histogram;              // likewise

    // A percentile is the smallest value that at least this share of the values does not exceed.
    // This is its number in ascending order, from 1.
    static std::int64_t rank(int thousandths, std::int64_t count) {
        const std::int64_t rounded_up =
            (thousandths * (count / 1000)) + (thousandths * (count % 1000) + 999) / 1000;
        return rounded_up > 0 ? rounded_up : 1;
    }
};

// Exact. In one parallel pass for samples of 8 and 16 bits, where the histogram's edges are whole
// numbers, and an interval as many values. For float32 in two, with 4 MiB a thread.
ValueStatistics measure_values(const VolumeData& data);

// Exact; takes as much memory as the values.
ValueStatistics measure_values(std::span<const double> values);

}  // namespace lamina
