// SPDX-License-Identifier: Apache-2.0
#include "reference/cell_batch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "fixtures.h"

namespace lamina {
namespace {

using reference_test::Random;

// In batches of every size the segments are those of the cells one by one; a constant cell is
// exactly constant.
TEST(CellBatch, SegmentsAreThoseOfSingleCells) {
    Random random(11);
    for (std::size_t count = 1; count <= CellBatch::capacity; ++count) {
        Chord chord;
        chord.entry = random.point(0, 20);
        chord.direction = random.point(-1, 1);
        chord.world_per_z = 1.5;
        CellBatch cells;
        std::vector<CellCorners> corners;
        for (std::size_t i = 0; i < count; ++i) {
            CellCorners values;
            for (double& value : values.v) value = i % 5 == 4 ? 7 : random.below(256);
            const double from = random.uniform(0, 9), to = from + random.uniform(0, 2);
            const glm::dvec3 at = chord.entry + from * chord.direction;
            // Also the half voxels before the first samples.
            const CellIndex cell{static_cast<std::int64_t>(std::floor(at.x)) - random.below(2),
                                 static_cast<std::int64_t>(std::floor(at.y)),
                                 static_cast<std::int64_t>(std::floor(at.z))};
            corners.push_back(values);
            cells.add(values, values.range(), cell, from, to);
        }
        SegmentBatch segments;
        make_segments(cells, chord, segments);
        ASSERT_EQ(segments.count, count);
        for (std::size_t i = 0; i < count; ++i) {
            const glm::dvec3 corner(cells.place[0][i], cells.place[1][i], cells.place[2][i]);
            const double along = cells.to[i] - cells.from[i];
            const Cubic expected = corners[i].along(chord.place_in_cell(corner, cells.from[i]),
                                                    along * chord.direction);
            for (std::size_t power = 0; power < 4; ++power) {
                // Sums of some eight products of values up to 255 times 8 and steps up to 2.
                EXPECT_NEAR(segments.scalar[power][i], expected.c[power], 2e-11);
                if (i % 5 == 4 && power > 0) {
                    EXPECT_EQ(segments.scalar[power][i], 0);
                }
            }
            EXPECT_EQ(segments.lo[i], std::ranges::min(corners[i].v));
            EXPECT_EQ(segments.hi[i], std::ranges::max(corners[i].v));
            EXPECT_EQ(segments.length[i], along * chord.world_per_z);
        }
    }
}

}  // namespace
}  // namespace lamina
