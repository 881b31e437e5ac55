// SPDX-License-Identifier: Apache-2.0
#include "reference/cells.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "fixtures.h"
#include "reference/transfer_intervals.h"

namespace lamina {
namespace {

using reference_test::Random;

TransferFunction visible_in(const std::vector<std::pair<double, double>>& ranges) {
    std::vector<TransferKnot> knots;
    const auto add = [&](double value, double extinction) {
        knots.push_back({value, {{1, 1, 1}, extinction}});
    };
    for (const auto& [lo, hi] : ranges) {
        add(lo, 0);
        add((lo + hi) / 2, 1);
        add(hi, 0);
    }
    if (knots.empty()) add(0, 0);
    return TransferFunction::linear(knots);
}

bool meets(const CellCorners& corners, const std::vector<std::pair<double, double>>& ranges) {
    const auto [lo, hi] = std::ranges::minmax(corners.v);
    return std::ranges::any_of(ranges,
                               [&](const auto& r) { return r.first <= hi && lo <= r.second; });
}

// Expects, for batches of every size, one segment for each cell that has only finite corners and
// meets a range of the function, as CellCorners computes it. A constant cell must be exactly
// constant.
void test_batches(const std::vector<std::pair<double, double>>& ranges, Random& random) {
    const TransferIntervals intervals(visible_in(ranges));
    for (std::size_t count = 1; count <= CellBatch::capacity; ++count) {
        Chord chord;
        chord.entry = random.point(0, 20);
        chord.direction = random.point(-1, 1);
        chord.world_per_z = 1.5;
        CellBatch cells;
        std::vector<CellCorners> corners;
        for (std::size_t i = 0; i < count; ++i) {
            CellCorners values;
            const int base = random.below(256), width = 1 + random.below(256);
            for (double& value : values.v) value = i % 5 == 4 ? base : base + random.below(width);
            if (i % 7 == 6) values.v[i % 8] = i % 2 == 0 ? NAN : INFINITY;
            const double from = random.uniform(0, 9), to = from + random.uniform(0, 2);
            const glm::dvec3 at = chord.entry + from * chord.direction;
            // Cells include the half voxels before the first samples.
            cells.add({static_cast<std::int64_t>(std::floor(at.x)) - random.below(2),
                       static_cast<std::int64_t>(std::floor(at.y)),
                       static_cast<std::int64_t>(std::floor(at.z))},
                      from, to);
            corners.push_back(values);
            for (std::size_t corner = 0; corner < 8; ++corner)
                cells.corners[corner][i] = values.v[corner];
        }
        SegmentBatch segments;
        make_segments(cells, chord, intervals.columns(), segments);
        std::size_t segment = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const auto& v = corners[i].v;
            if (!std::ranges::all_of(v, [](double value) { return std::isfinite(value); }))
                continue;
            if (!meets(corners[i], ranges)) continue;
            ASSERT_LT(segment, segments.count);
            EXPECT_EQ(segments.cell[segment], static_cast<std::int64_t>(i));
            const glm::dvec3 corner(cells.cell[0][i], cells.cell[1][i], cells.cell[2][i]);
            const double along = cells.to[i] - cells.from[i];
            const Cubic expected = corners[i].along(chord.place_in_cell(corner, cells.from[i]),
                                                    along * chord.direction);
            for (std::size_t power = 0; power < 4; ++power) {
                // Rounding: sums of some eight products of values up to 512 times 8 and steps up to
                // 2.
                EXPECT_NEAR(segments.scalar[power][segment], expected.c[power], 4e-11);
                if (i % 5 == 4 && power > 0) {
                    EXPECT_EQ(segments.scalar[power][segment], 0);
                }
            }
            EXPECT_EQ(segments.lo[segment], std::ranges::min(v));
            EXPECT_EQ(segments.hi[segment], std::ranges::max(v));
            EXPECT_EQ(segments.length[segment], along * chord.world_per_z);
            ++segment;
        }
        EXPECT_EQ(segment, segments.count);
    }
}

TEST(CellBatch, SegmentsEqualThoseOfSingleCells) {
    Random random(11);
    test_batches({}, random);
    test_batches({{-1, 1000}}, random);
    test_batches({{100, 130}}, random);
    test_batches({{5, 10}, {100, 130}}, random);
    std::vector<std::pair<double, double>> many;
    for (int i = 0; i < 41; ++i) many.push_back({10 * i, 10 * i + 1});
    test_batches(many, random);
}

// Tests cells inside the volume and in the half voxels around it.
template <typename Sample>
void test_fetch(Random& random) {
    const Grid grid = reference_test::make_grid({5, 1, 4}, Centering::cell, {1, 1, 1});
    std::vector<Sample> samples(static_cast<std::size_t>(grid.sample_count()));
    for (Sample& sample : samples) sample = static_cast<Sample>(random.below(200));
    const CellSamples<const Sample*> cells(grid, samples.data());
    CellBatch batch;
    while (batch.count < CellBatch::capacity)
        batch.add({random.below(6) - 1, random.below(2) - 1, random.below(5) - 1}, 0, 1);
    cells.fetch(batch);
    for (std::size_t i = 0; i < batch.count; ++i) {
        const CellCorners expected =
            cells.corners({batch.cell[0][i], batch.cell[1][i], batch.cell[2][i]});
        for (std::size_t corner = 0; corner < 8; ++corner)
            EXPECT_EQ(batch.corners[corner][i], expected.v[corner]);
    }
}

TEST(CellBatch, SamplesEqualThoseOfTheCells) {
    Random random(12);
    test_fetch<std::uint8_t>(random);
    test_fetch<float>(random);
}

}  // namespace
}  // namespace lamina
