// SPDX-License-Identifier: Apache-2.0
#include "reference/cell_walk.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "fixtures.h"
#include "reference/transfer_intervals.h"
#include "support/each_instruction_set.h"
#include "visible_bits.h"

namespace lamina {
namespace {

using reference_test::cell_shows;
using reference_test::make_grid;
using reference_test::make_volume;
using reference_test::Random;

struct Passed {
    CellIndex cell;
    double from, to;
    bool operator==(const Passed&) const = default;
};
using PassedCells = std::vector<Passed>;

// Returns a random chord through the box: many are along axes, in planes between cells, or through
// edges of cells.
Chord random_chord(const Grid& grid, Random& random) {
    const glm::dvec3 lowest = grid.index_min(), highest = grid.index_max();
    glm::dvec3 a = lowest + random.point(0, 1) * (highest - lowest);
    glm::dvec3 b = lowest + random.point(0, 1) * (highest - lowest);
    const int axis = random.below(3);
    switch (random.below(7)) {
        case 0:
            b[axis] = a[axis];
            break;
        case 1:
            a[axis] = random.below(2) == 0 ? lowest[axis] : highest[axis];
            break;
        case 2:
            for (int i = 0; i < 3; ++i) {
                a[i] = std::clamp(std::round(a[i]), lowest[i], highest[i]);
                b[i] = std::clamp(std::round(b[i]), lowest[i], highest[i]);
            }
            break;
        case 3:
            b = a + 1e-7 * (b - a);
            break;
        default:
            break;
    }
    Chord chord;
    chord.entry = a;
    chord.direction = b - a;
    chord.length_z = random.uniform(.5, 1);
    const int kind = random.below(7);
    if (kind < 2) {  // nearly, or quite, in a plane or along an axis
        constexpr std::array slopes{0., -0., 1e-300, -1e-300, 1e-310, -5e-324};
        const auto slope = [&] { return slopes[static_cast<std::size_t>(random.below(6))]; };
        chord.direction[axis] = slope();
        if (kind == 0) chord.direction[(axis + 1) % 3] = slope();
    } else if (kind == 2) {
        const double scale = std::ldexp(1, 10 * random.below(100) - 500);
        chord.direction *= scale;
        chord.length_z /= scale;
    }
    return chord;
}

PassedCells passed_alone(const Grid& grid, const VisibleCells& visible, const Chord& chord) {
    PassedCells passed;
    CellWalk(grid, chord).run([&](const CellIndex& cell, double from, double to) {
        if (cell_shows(visible, cell)) passed.push_back({cell, from, to});
        return true;
    });
    return passed;
}

void take(CellBatch& batch, PassedCells& passed) {
    for (std::size_t i = 0; i < batch.count; ++i)
        passed.push_back(
            {{batch.cell[0][i], batch.cell[1][i], batch.cell[2][i]}, batch.from[i], batch.to[i]});
    batch.count = 0;
}

// Returns the cells that walk_cells() passes for each chord. Each chord takes the first free lane.
// Batches are of any size; every seventh chord stops after its first batch.
std::vector<PassedCells> passed_side_by_side(const GridAxes& grid, const VisibleCells& visible,
                                             const std::vector<Chord>& chords, Random& random) {
    std::vector<PassedCells> passed(chords.size());
    CellLanes lanes{};
    std::vector<CellBatch> batches(CellLanes::width);
    std::array<CellBatch*, CellLanes::width> pointers;
    std::array<std::size_t, CellLanes::width> chord_of{};
    std::size_t next = 0;
    const auto enter = [&](std::size_t lane) {
        if (next == chords.size()) return;
        batches[lane].wanted = 1 + static_cast<std::size_t>(random.below(32));
        chord_of[lane] = next;
        enter_cells(lanes, lane, grid, chords[next++]);
    };
    for (std::size_t lane = 0; lane < CellLanes::width; ++lane) {
        pointers[lane] = &batches[lane];
        enter(lane);
    }
    while (lanes.walking != 0) {
        const LaneSet done = walk_cells(lanes, visible, pointers);
        EXPECT_NE(done, 0U);
        for_each_lane(done, [&](std::size_t lane) {
            take(batches[lane], passed[chord_of[lane]]);
            if (chord_of[lane] % 7 == 6) lanes.stop(lane);
            if ((lanes.walking & lane_bit(lane)) == 0) enter(lane);
        });
    }
    return passed;
}

// Compares both walks in a box in which a number of samples (specks) show something.
void test_walks(const std::array<std::int64_t, 3>& size, Centering centering, int specks) {
    Random random(8);
    const Grid grid = make_grid(size, centering);
    std::vector<std::uint8_t> samples(static_cast<std::size_t>(grid.sample_count()));
    for (int speck = 0; speck < specks; ++speck)
        samples[static_cast<std::size_t>(random.below(static_cast<int>(samples.size())))] = 15;
    const TransferIntervals transfer(
        TransferFunction::linear({{10, {{1, 1, 1}, 0}}, {20, {{1, 1, 1}, 1}}}));
    const VisibleCells visible(make_volume<std::uint8_t>(grid, samples), transfer);
    std::vector<Chord> chords;
    std::vector<PassedCells> expected;
    std::size_t count = 0;
    for (int i = 0; i < 2000; ++i) {
        chords.push_back(random_chord(grid, random));
        expected.push_back(passed_alone(grid, visible, chords.back()));
        count += expected.back().size();
    }
    EXPECT_GT(count, 100U);
    test::for_each_instruction_set([&](const std::string& name) {
        Random sizes(3);
        const auto found = passed_side_by_side(GridAxes(grid), visible, chords, sizes);
        for (std::size_t i = 0; i < chords.size(); ++i) {
            PassedCells wanted = expected[i];
            if (i % 7 == 6) {  // the walk was stopped after its first batch
                ASSERT_EQ(found[i].empty(), wanted.empty()) << name << ", chord " << i;
                wanted.resize(found[i].size());
            }
            ASSERT_EQ(found[i], wanted) << name << ", chord " << i;
        }
    });
}

// Lanes pass those cells of CellWalk that may be visible, with the same parameters.
TEST(CellLanes, PassTheCellsOfASingleWalk) {
    test_walks({40, 33, 25}, Centering::cell, 30);
    test_walks({40, 33, 25}, Centering::node, 400);
    test_walks({1, 30, 9}, Centering::cell, 30);
    test_walks({600, 7, 8}, Centering::cell, 100);  // more than 64 blocks in a line
}

}  // namespace
}  // namespace lamina
