// SPDX-License-Identifier: Apache-2.0
#include "volume/min_max_bricks.h"

#include <cmath>
#include <limits>
#include <type_traits>

#include "base/parallel.h"
#include "volume/volume_data.h"

namespace lamina {
namespace {

constexpr std::int64_t edge = MinMaxBricks::edge;

// Minima and maxima over several lines along x: lo[i] and hi[i] are those of sample i of all lines
// included so far; lo[i] > hi[i] if none of these samples is finite.
template <typename T>
struct Extrema {
    explicit Extrema(std::size_t count)
        : lo(count, std::numeric_limits<T>::max()), hi(count, std::numeric_limits<T>::lowest()) {}

    // Includes a line of lo.size() samples, without branches, so that compilers vectorise the loop.
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

    // Sets the range of brick `number` from the extrema first .. first + count - 1.
    void set_range(std::int64_t first, std::int64_t count, std::size_t number,
                   BrickRanges& ranges) const {
        T least = *std::min_element(lo.begin() + first, lo.begin() + first + count);
        T most = *std::max_element(hi.begin() + first, hi.begin() + first + count);
        if (least > most) {
            least = 1;
            most = 0;
        }
        if (least != 0 || most != 0) ranges.set(number, least, most);
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

// The samples begin .. end - 1 that consecutive bricks touch along an axis. Those before owned_end
// are counted with these bricks; a border sample is counted with the next brick only.
struct Touched {
    std::int64_t begin, end, owned_end;
};
Touched touched(const Grid& grid, const MinMaxBricks& bricks, std::size_t axis, std::int64_t first,
                std::int64_t count) {
    const std::int64_t samples = grid.size[axis], last = first + count;
    const std::int64_t end = std::min(samples, last * edge + 1);
    return {first * edge, end, last == bricks.count[axis] ? samples : last * edge};
}

// Measures one row of bricks along x at a time: first takes the extrema over the row's (edge + 1)^2
// lines of samples, then, for each brick, over its edge + 1 samples along x.
template <typename T>
BlockExtent measure_window(const Grid& grid, const SampleWindow<T>& window,
                           const std::array<std::int64_t, 3>& first,
                           const std::array<std::int64_t, 3>& count, MinMaxBricks& bricks) {
    BlockExtent extent;
    const Touched x = touched(grid, bricks, 0, first[0], count[0]);
    for (std::int64_t bz = first[2]; bz < first[2] + count[2]; ++bz) {
        const Touched z = touched(grid, bricks, 2, bz, 1);
        for (std::int64_t by = first[1]; by < first[1] + count[1]; ++by) {
            const Touched y = touched(grid, bricks, 1, by, 1);
            Extrema<T> row(static_cast<std::size_t>(x.end - x.begin));
            for (std::int64_t k = z.begin; k < z.end; ++k) {
                for (std::int64_t j = y.begin; j < y.end; ++j) {
                    const T* const line = window.row(j, k) + (x.begin - window.box.first[0]);
                    row.include(line);
                    if (j < y.owned_end && k < z.owned_end)
                        extent.non_finite += count_non_finite(line, x.owned_end - x.begin);
                }
            }
            std::size_t number =
                static_cast<std::size_t>((bz * bricks.count[1] + by) * bricks.count[0] + first[0]);
            for (std::int64_t bx = 0; bx < count[0]; ++bx, ++number) {
                row.set_range(bx * edge, std::min(edge + 1, x.end - x.begin - bx * edge), number,
                              bricks.ranges);
                extent.whole = joined(extent.whole, bricks.range(number));
            }
        }
    }
    return extent;
}

}  // namespace

ValueRange joined(const ValueRange& a, const ValueRange& b) {
    if (a.empty() || b.empty()) return a.empty() ? b : a;
    return {std::min(a.lo, b.lo), std::max(a.hi, b.hi)};
}

MinMaxBricks MinMaxBricks::of(const Grid& grid, SampleType type) {
    MinMaxBricks bricks;
    for (std::size_t axis = 0; axis < 3; ++axis) bricks.count[axis] = bricks_along(grid.size[axis]);
    bricks.ranges = BrickRanges(
        static_cast<std::size_t>(bricks.count[0] * bricks.count[1] * bricks.count[2]), type);
    return bricks;
}

BlockExtent measure_block(const Grid& grid, const SampleBox& box, const void* samples,
                          const std::array<std::int64_t, 3>& first,
                          const std::array<std::int64_t, 3>& count, MinMaxBricks& bricks) {
    return with_sample_type(bricks.ranges.type(), [&](auto zero) {
        const SampleWindow<decltype(zero)> window{box, static_cast<const decltype(zero)*>(samples)};
        return measure_window(grid, window, first, count, bricks);
    });
}

MinMaxBricks measure_bricks(const Volume& volume) {
    if (!volume.in_memory()) return index_of(volume).bricks;
    const Grid& grid = volume.grid();
    MinMaxBricks bricks = MinMaxBricks::of(grid, volume.type());
    const std::int64_t rows = bricks.count[1] * bricks.count[2];
    std::vector<BlockExtent> extents(static_cast<std::size_t>(rows));
    parallel_for(rows, 16, [&](std::int64_t row) {
        extents[static_cast<std::size_t>(row)] = measure_block(
            grid, {{0, 0, 0}, grid.size}, volume.data(),
            {0, row % bricks.count[1], row / bricks.count[1]}, {bricks.count[0], 1, 1}, bricks);
    });
    for (const BlockExtent& extent : extents) {
        bricks.whole = joined(bricks.whole, extent.whole);
        bricks.non_finite += extent.non_finite;
    }
    return bricks;
}

}  // namespace lamina
