// SPDX-License-Identifier: Apache-2.0
#include "volume/min_max_bricks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "base/parallel.h"

namespace lamina {
namespace {

constexpr std::int64_t edge = MinMaxBricks::edge;

// Minima and maxima in the samples' own type; lo > hi where there is nothing finite.
template <typename T>
struct Extrema {
    explicit Extrema(std::size_t count)
        : lo(count, std::numeric_limits<T>::max()), hi(count, std::numeric_limits<T>::lowest()) {}

    // Includes line[i] in the extrema of element i. The loop has no branches, so that it becomes
    // vector instructions.
    void include(const T* line) {
        for (std::size_t i = 0; i < lo.size(); ++i) {
            T low = line[i], high = line[i];
            if constexpr (std::is_floating_point_v<T>) {
                const bool finite = std::abs(low) <= std::numeric_limits<T>::max();
                low = finite ? low : std::numeric_limits<T>::max();
                high = finite ? high : std::numeric_limits<T>::lowest();
            }
            lo[i] = low < lo[i] ? low : lo[i];
            hi[i] = high > hi[i] ? high : hi[i];
        }
    }

    MinMaxBricks::Range range(std::int64_t first, std::int64_t count) const {
        const T least = *std::min_element(lo.begin() + first, lo.begin() + first + count);
        const T most = *std::max_element(hi.begin() + first, hi.begin() + first + count);
        if (least > most) return {};
        return {static_cast<float>(least), static_cast<float>(most)};
    }

    std::vector<T> lo, hi;
};

template <typename T>
std::int64_t count_non_finite(const T* samples, std::int64_t count) {
    if constexpr (std::is_floating_point_v<T>) {
        return std::count_if(samples, samples + count,
                             [](T value) { return !std::isfinite(value); });
    }
    return 0;
}

std::int64_t bricks_along(std::int64_t samples) {
    return std::max<std::int64_t>(1, (samples - 1 + edge - 1) / edge);
}

// Measures all bricks of one row along x; returns how many non-finite samples the row owns. A brick
// owns its samples but the last along each axis, which the next brick owns where there is one.
template <typename T>
std::int64_t measure_row(const Grid& grid, const T* samples, std::int64_t by, std::int64_t bz,
                         MinMaxBricks& bricks) {
    const auto [nx, ny, nz] = grid.size;
    const std::int64_t y_end = std::min(ny, (by + 1) * edge + 1);
    const std::int64_t z_end = std::min(nz, (bz + 1) * edge + 1);
    const std::int64_t owned_y_end = by + 1 == bricks.count[1] ? ny : (by + 1) * edge;
    const std::int64_t owned_z_end = bz + 1 == bricks.count[2] ? nz : (bz + 1) * edge;
    Extrema<T> row(static_cast<std::size_t>(nx));
    std::int64_t non_finite = 0;
    for (std::int64_t z = bz * edge; z < z_end; ++z) {
        for (std::int64_t y = by * edge; y < y_end; ++y) {
            const T* const line = samples + (z * ny + y) * nx;
            row.include(line);
            if (y < owned_y_end && z < owned_z_end) non_finite += count_non_finite(line, nx);
        }
    }
    MinMaxBricks::Range* const out =
        &bricks.ranges[static_cast<std::size_t>((bz * bricks.count[1] + by) * bricks.count[0])];
    for (std::int64_t bx = 0; bx < bricks.count[0]; ++bx)
        out[bx] = row.range(bx * edge, std::min(edge + 1, nx - bx * edge));
    return non_finite;
}

void include(ValueRange& whole, const ValueRange& part) {
    if (part.empty()) return;
    whole =
        whole.empty() ? part : ValueRange{std::min(whole.lo, part.lo), std::max(whole.hi, part.hi)};
}

}  // namespace

MinMaxBricks measure_bricks(const Volume& volume) {
    MinMaxBricks bricks;
    for (int axis = 0; axis < 3; ++axis)
        bricks.count[axis] = bricks_along(volume.grid().size[axis]);
    bricks.ranges.resize(
        static_cast<std::size_t>(bricks.count[0] * bricks.count[1] * bricks.count[2]));
    const std::int64_t rows = bricks.count[1] * bricks.count[2];
    std::vector<std::int64_t> non_finite(static_cast<std::size_t>(rows));
    volume.visit([&](const auto* samples) {
        parallel_for(rows, 16, [&](std::int64_t row) {
            non_finite[static_cast<std::size_t>(row)] = measure_row(
                volume.grid(), samples, row % bricks.count[1], row / bricks.count[1], bricks);
        });
    });
    for (const std::int64_t count : non_finite) bricks.non_finite += count;
    for (const MinMaxBricks::Range& range : bricks.ranges) include(bricks.whole, range);
    return bricks;
}

}  // namespace lamina
