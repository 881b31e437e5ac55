// SPDX-License-Identifier: Apache-2.0
// Shared by both kinds of tables: limits, conversion to float, and the neighbours of a coordinate.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>

namespace lamina {

// Memory that a table may take, in bytes.
inline constexpr std::size_t most_table_bytes = std::size_t{1} << 30;

// Transmittance below which the rest of a segment is skipped: it is far below a float's precision.
inline constexpr double least_transmittance = 1e-12;

// Converts to float; numbers beyond float's range become its largest.
inline float as_float(double x) {
    return static_cast<float>(std::min<double>(x, std::numeric_limits<float>::max()));
}

// The two neighbours of a coordinate on one axis of a table.
struct TableNeighbors {
    std::size_t first, second;
    double weight;  // weight of the second; the first has 1 - weight
};

// Returns the neighbours of a coordinate among `count` nodes, 0 .. count - 1.
inline TableNeighbors neighbors_of(double coordinate, std::size_t count) {
    const auto first = std::min(static_cast<std::size_t>(coordinate), count - 1);
    return {first, std::min(first + 1, count - 1), coordinate - static_cast<double>(first)};
}

}  // namespace lamina
