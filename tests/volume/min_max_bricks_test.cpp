// SPDX-License-Identifier: Apache-2.0
#include "volume/min_max_bricks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace lamina {
namespace {

template <typename T>
Volume make_volume(std::array<std::int64_t, 3> size, SampleType type,
                   const std::vector<T>& values) {
    Grid grid;
    grid.size = size;
    grid.centering.fill(Centering::cell);
    const auto samples = std::make_shared<std::vector<T>>(values);
    return Volume(grid, type, std::shared_ptr<const void>(samples, samples->data()));
}

// Compares the range of every brick with that of a loop over the samples that interpolation within
// its cells can touch.
void expect_ranges(const MinMaxBricks& bricks, const std::array<std::int64_t, 3>& size,
                   const std::vector<float>& values) {
    const std::int64_t edge = MinMaxBricks::edge;
    for (std::int64_t bz = 0; bz < bricks.count[2]; ++bz)
        for (std::int64_t by = 0; by < bricks.count[1]; ++by)
            for (std::int64_t bx = 0; bx < bricks.count[0]; ++bx) {
                ValueRange expected;
                for (std::int64_t z = bz * edge; z <= std::min((bz + 1) * edge, size[2] - 1); ++z)
                    for (std::int64_t y = by * edge; y <= std::min((by + 1) * edge, size[1] - 1);
                         ++y)
                        for (std::int64_t x = bx * edge;
                             x <= std::min((bx + 1) * edge, size[0] - 1); ++x) {
                            const double v =
                                values[static_cast<std::size_t>((z * size[1] + y) * size[0] + x)];
                            if (!std::isfinite(v)) continue;
                            if (expected.empty()) expected = {v, v};
                            expected = {std::min(expected.lo, v), std::max(expected.hi, v)};
                        }
                EXPECT_EQ(bricks.at(bx, by, bz).lo, expected.lo) << bx << " " << by << " " << bz;
                EXPECT_EQ(bricks.at(bx, by, bz).hi, expected.hi) << bx << " " << by << " " << bz;
            }
}

TEST(MinMaxBricks, AgreeWithALoopOverAllSamples) {
    const std::array<std::int64_t, 3> size{51, 17, 34};  // cells in the last bricks: 2, 4, 1
    std::mt19937 random(1);
    std::normal_distribution<float> normal;
    std::vector<float> values(51 * 17 * 34);
    for (float& value : values) value = normal(random);
    values[0] = std::numeric_limits<float>::quiet_NaN();
    values[16] = std::numeric_limits<float>::infinity();  // shared by two bricks, counted once
    values.back() = -std::numeric_limits<float>::infinity();
    const MinMaxBricks bricks = measure_bricks(make_volume(size, SampleType::float32, values));
    EXPECT_EQ(bricks.count, (std::array<std::int64_t, 3>{13, 4, 9}));
    expect_ranges(bricks, size, values);
    EXPECT_EQ(bricks.non_finite, 3);
    float lo = 0, hi = 0;
    for (const float value : values) {
        if (!std::isfinite(value)) continue;
        lo = std::min(lo, value);
        hi = std::max(hi, value);
    }
    EXPECT_EQ(bricks.whole.lo, lo);
    EXPECT_EQ(bricks.whole.hi, hi);
}

TEST(MinMaxBricks, KeepTheExtremesOfIntegers) {
    const MinMaxBricks bricks = measure_bricks(
        make_volume<std::int16_t>({2, 2, 1}, SampleType::int16, {-32768, 5, 32767, 0}));
    EXPECT_EQ(bricks.ranges.size(), 1u);
    EXPECT_EQ(bricks.whole.lo, -32768);
    EXPECT_EQ(bricks.whole.hi, 32767);
    EXPECT_EQ(bricks.non_finite, 0);
}

TEST(MinMaxBricks, AreEmptyWithoutFiniteSamples) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const MinMaxBricks bricks =
        measure_bricks(make_volume<float>({2, 1, 1}, SampleType::float32, {nan, nan}));
    EXPECT_TRUE(bricks.whole.empty());
    EXPECT_TRUE(bricks.at(0, 0, 0).empty());
    EXPECT_EQ(bricks.non_finite, 2);
}

}  // namespace
}  // namespace lamina
