// SPDX-License-Identifier: Apache-2.0
#include "volume/volume_store.h"

#include <gtest/gtest.h>

#include <random>

#include "support/stored_volume.h"
#include "support/volume_of.h"

namespace lamina {
namespace {

using Triple = std::array<std::int64_t, 3>;

constexpr Triple flat_size{90, 40, 1};

// The value at a place. Some min/max bricks along x have a single value.
double step_at(double x, double y, double /*z*/) {
    return x >= 4 && x <= 14 ? 7 : static_cast<double>(static_cast<int>(x + 90 * y) % 251);
}

TEST(ScatteredSamples, MatchTheSamplesOfTheVolume) {
    const Volume volume =
        test::volume_of<std::uint8_t>(test::grid_of(flat_size, Centering::node), step_at);
    const Volume stored = test::stored(volume);
    const MinMaxBricks bricks = measure_bricks(volume);
    std::mt19937 random(3);
    for (int trial = 0; trial < 2000; ++trial) {
        Triple lower{}, upper{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            lower[axis] = static_cast<std::int64_t>(random()) % flat_size[axis];
            upper[axis] = std::min(lower[axis] + trial % 2, flat_size[axis] - 1);
        }
        std::array<double, 8> expected{};
        for (std::size_t i = 0; i < 8; ++i) {
            const auto at = [&](std::size_t axis) {
                return static_cast<double>((i >> axis & 1) != 0 ? upper[axis] : lower[axis]);
            };
            expected[i] = step_at(at(0), at(1), at(2));
        }
        EXPECT_EQ(scattered_corners(volume, nullptr, lower, upper), expected);
        EXPECT_EQ(scattered_corners(stored, nullptr, lower, upper), expected);
        EXPECT_EQ(scattered_corners(stored, &bricks, lower, upper), expected);
        EXPECT_EQ(scattered_sample(stored, lower), expected[0]);
    }
    EXPECT_EQ(stored.store().bricks().bricks_read(), 0);
}

}  // namespace
}  // namespace lamina
