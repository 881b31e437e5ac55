// SPDX-License-Identifier: Apache-2.0
#include "reference/visible_cells.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "fixtures.h"

namespace lamina {
namespace {

using reference_test::make_grid;
using reference_test::make_volume;
using reference_test::Random;

// Extinction in `count` ranges of width 4, 10 apart, the first at `first`.
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

// Cells that may show something are those whose range of values meets one of the function's, by a
// look at every cell; with many ranges others may be among them.
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
    for (std::int64_t z = 0; z < size[2]; ++z) {
        for (std::int64_t y = 0; y < size[1]; ++y) {
            for (std::int64_t x = -1; x < size[0]; ++x) {
                double lo = INFINITY, hi = -INFINITY;
                for (int corner = 0; corner < 8; ++corner) {
                    const std::int64_t cx =
                        std::clamp<std::int64_t>(x + (corner & 1), 0, size[0] - 1);
                    const std::int64_t cy = std::min(y + (corner >> 1 & 1), size[1] - 1);
                    const std::int64_t cz = std::min(z + (corner >> 2), size[2] - 1);
                    const auto value = static_cast<double>(
                        samples[static_cast<std::size_t>((cz * size[1] + cy) * size[0] + cx)]);
                    lo = std::isnan(value) ? -INFINITY : std::min(lo, value);
                    hi = std::max(hi, value);
                }
                const CellIndex cell{x, y, z};
                const CellBlock block = cells.block_of(cell);
                for (int axis = 0; axis < 3; ++axis)
                    ASSERT_TRUE(block.holds(cell[static_cast<std::size_t>(axis)], axis));
                const bool shown = !block.hidden && VisibleCells::may_show(block, cell);
                if (transfer.visible(lo, hi) && std::isfinite(lo) && std::isfinite(hi)) {
                    ASSERT_TRUE(shown) << x << ' ' << y << ' ' << z;
                } else if (exact && x >= 0 && std::isfinite(lo) && std::isfinite(hi)) {
                    ASSERT_FALSE(shown) << x << ' ' << y << ' ' << z;
                }
            }
        }
    }
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
    // Between two integers, of which neither shows anything.
    test_cells<Sample>(TransferFunction::linear(
                           {{6.25, {{1, 1, 1}, 0}}, {6.5, {{1, 1, 1}, 1}}, {6.75, {{1, 1, 1}, 0}}}),
                       true, random);
    // Both ends have extinction: the ranges have no end.
    test_cells<Sample>(TransferFunction::linear({{4, {{1, 1, 1}, 2}},
                                                 {5.25, {{1, 1, 1}, 0}},
                                                 {20.5, {{1, 1, 1}, 0}},
                                                 {21, {{1, 1, 1}, 1}}}),
                       true, random);
}

TEST(VisibleCells, AreThoseWhoseRangeMeetsTheFunctions) {
    test_type<std::uint8_t>();
    test_type<std::int16_t>();
    test_type<std::uint16_t>();
    test_type<float>();
}

struct Visit {
    CellIndex cell;
    double from, to;
    bool operator==(const Visit&) const = default;
};

// A walk that leaves out hidden blocks visits the other cells of one that does not, with the same
// parameters.
TEST(VisibleCells, HiddenBlocksAreLeftOutOfWalks) {
    Random random(8);
    for (const std::array<std::int64_t, 3>& size :
         {std::array<std::int64_t, 3>{40, 33, 25}, {1, 30, 9}}) {
        const Grid grid = make_grid(size, Centering::cell, {1, 1, 1});
        std::vector<float> samples(static_cast<std::size_t>(grid.sample_count()));
        for (int speck = 0; speck < 12; ++speck)
            samples[static_cast<std::size_t>(random.uniform(0, double(samples.size())))] = 15;
        const TransferIntervals transfer(ranges(1, 12));
        const VisibleCells cells(make_volume<float>(grid, samples), transfer);
        std::size_t visited = 0, left_out = 0;
        for (int ray = 0; ray < 3000; ++ray) {
            Chord chord;
            const glm::dvec3 lowest = grid.index_min(), highest = grid.index_max();
            const glm::dvec3 a = lowest + random.point(0, 1) * (highest - lowest);
            glm::dvec3 b = lowest + random.point(0, 1) * (highest - lowest);
            if (ray % 5 == 0) b[ray % 3] = a[ray % 3];
            chord.entry = a;
            chord.direction = b - a;
            chord.length_z = 1;
            std::vector<Visit> expected, found;
            CellWalk(grid, chord).run([&](const CellIndex& cell, double from, double to) {
                if (cells.block_of(cell).hidden) {
                    ++left_out;
                } else {
                    expected.push_back({cell, from, to});
                }
                return true;
            });
            CellWalk(grid, chord)
                .run(
                    [&](const CellIndex& cell, double from, double to, const CellBlock&) {
                        found.push_back({cell, from, to});
                        return true;
                    },
                    [&](const CellIndex& cell) { return cells.block_of(cell); });
            ASSERT_EQ(found, expected);
            visited += found.size();
        }
        EXPECT_GT(visited, 0U);
        EXPECT_GT(left_out, 0U);
    }
}

}  // namespace
}  // namespace lamina
