// SPDX-License-Identifier: Apache-2.0
#include "reference/cells.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "fixtures.h"
#include "visible_bits.h"

namespace lamina {
namespace {

using reference_test::block_of;
using reference_test::block_shows;
using reference_test::cell_shows;
using reference_test::make_grid;
using reference_test::make_volume;
using reference_test::Random;

// Returns a function with extinction in `count` ranges of width 4, whose starts are 10 apart, the
// first at `first`.
TransferFunction ranges(int count, double first) {
    std::vector<TransferKnot> knots;
    const auto add = [&](double value, double extinction) {
        knots.push_back({value, {{1, 1, 1}, extinction}});
    };
    for (int i = 0; i < count; ++i) {
        add(first + 10 * i, 0);
        add(first + 10 * i + 2, 1);
        add(first + 10 * i + 4, 0);
    }
    return TransferFunction::linear(knots);
}

// Expects that a block's bit is set exactly if one of its cells' bits is, and no other bit.
void expect_blocks_of_cells(const VisibleCells& cells, const Grid& grid) {
    const auto& size = grid.size;
    std::vector<std::uint64_t> expected(
        static_cast<std::size_t>(cells.count()[1] * cells.count()[2] * cells.line_bits() / 64));
    for (std::int64_t z = -1; z < size[2]; ++z) {
        for (std::int64_t y = -1; y < size[1]; ++y) {
            for (std::int64_t x = -1; x < size[0]; ++x) {
                if (!cell_shows(cells, {x, y, z})) continue;
                const auto [bx, by, bz] = block_of({x, y, z});
                const std::int64_t bit = (bz * cells.count()[1] + by) * cells.line_bits() + bx;
                expected[static_cast<std::size_t>(bit / 64)] |= std::uint64_t{1} << bit % 64;
                ASSERT_TRUE(block_shows(cells, {bx, by, bz}));
            }
        }
    }
    ASSERT_EQ(std::vector(cells.blocks(), cells.blocks() + expected.size()), expected);
}

// Expects, by a look at every cell, that a cell's bit is set if its range of values meets one of
// the function's ranges. If not `exact` (many ranges), other bits may be set, too.
template <typename Sample>
void test_cells(const TransferFunction& function, bool exact, Random& random) {
    const TransferIntervals transfer(function);
    const Grid grid = make_grid({19, 9, 17}, Centering::cell, {1, 1, 1});
    std::vector<Sample> samples(static_cast<std::size_t>(grid.sample_count()));
    for (Sample& sample : samples)
        sample = static_cast<Sample>(random.below(random.below(20) == 0 ? 250 : 12));
    if constexpr (std::is_floating_point_v<Sample>) {
        samples[40] = std::numeric_limits<Sample>::infinity();
        samples[900] = -samples[40];
        samples[1500] = std::numeric_limits<Sample>::quiet_NaN();
    }
    const Volume volume = make_volume<Sample>(grid, samples);
    const VisibleCells cells(volume, transfer);
    const auto& size = grid.size;
    for (std::int64_t z = -1; z < size[2]; ++z) {
        for (std::int64_t y = -1; y < size[1]; ++y) {
            for (std::int64_t x = -1; x < size[0]; ++x) {
                double lo = INFINITY, hi = -INFINITY;
                for (int corner = 0; corner < 8; ++corner) {
                    const auto at = [&](std::int64_t cell, int axis) {
                        const std::int64_t last = size[static_cast<std::size_t>(axis)] - 1;
                        return std::clamp<std::int64_t>(cell + (corner >> axis & 1), 0, last);
                    };
                    const auto value = static_cast<double>(samples[static_cast<std::size_t>(
                        (at(z, 2) * size[1] + at(y, 1)) * size[0] + at(x, 0))]);
                    lo = std::isnan(value) ? -INFINITY : std::min(lo, value);
                    hi = std::max(hi, value);
                }
                if (transfer.visible(lo, hi) && std::isfinite(lo) && std::isfinite(hi)) {
                    ASSERT_TRUE(cell_shows(cells, {x, y, z})) << x << ' ' << y << ' ' << z;
                } else if (exact && std::isfinite(lo) && std::isfinite(hi)) {
                    ASSERT_FALSE(cell_shows(cells, {x, y, z})) << x << ' ' << y << ' ' << z;
                }
            }
        }
    }
    expect_blocks_of_cells(cells, grid);
}

template <typename Sample>
void test_type() {
    Random random(3);
    const TransferFunction nothing =
        TransferFunction::linear({{0, {{1, 1, 1}, 0}}, {1, {{1, 1, 1}, 0}}});
    test_cells<Sample>(nothing, true, random);
    for (const int count : {1, 3, 8}) test_cells<Sample>(ranges(count, 13.5), true, random);
    test_cells<Sample>(ranges(1, -1e9), true, random);
    test_cells<Sample>(ranges(1, 1e9), true, random);
    test_cells<Sample>(ranges(20, 5.5), false, random);
    // This range lies between two integers that show nothing themselves.
    test_cells<Sample>(TransferFunction::linear(
                           {{6.25, {{1, 1, 1}, 0}}, {6.5, {{1, 1, 1}, 1}}, {6.75, {{1, 1, 1}, 0}}}),
                       true, random);
    // Both ends have extinction, so the outer ranges are unbounded.
    test_cells<Sample>(TransferFunction::linear({{4, {{1, 1, 1}, 2}},
                                                 {5.25, {{1, 1, 1}, 0}},
                                                 {20.5, {{1, 1, 1}, 0}},
                                                 {21, {{1, 1, 1}, 1}}}),
                       true, random);
}

TEST(VisibleCells, AreThoseWhoseRangeMeetsTheVisibleValues) {
    test_type<std::uint8_t>();
    test_type<std::int16_t>();
    test_type<std::uint16_t>();
    test_type<float>();
}

}  // namespace
}  // namespace lamina
