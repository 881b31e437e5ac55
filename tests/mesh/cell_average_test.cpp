// SPDX-License-Identifier: Apache-2.0
#include "mesh/tet_mesh.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lamina {
namespace {

TEST(CellAverage, IsTheMeanOverTheTetsAroundAPoint) {
    const std::vector<Tet> tets{{0, 1, 2, 3}, {1, 2, 3, 4}, {2, 3, 4, 5}};
    const MeshScalar mean = average_to_points(7, tets, {"c", {1, 2, 6}});
    EXPECT_EQ(mean.name, "c");
    ASSERT_EQ(mean.values.size(), 7u);
    EXPECT_EQ(mean.values[0], 1);
    EXPECT_EQ(mean.values[1], 1.5);
    EXPECT_NEAR(mean.values[2], 3, 1e-15 * 3);  // thirds are rounded
    EXPECT_NEAR(mean.values[3], 3, 1e-15 * 3);
    EXPECT_EQ(mean.values[4], 4);
    EXPECT_EQ(mean.values[5], 6);
    EXPECT_EQ(mean.values[6], 1);  // no tet around it: the first finite value
}

TEST(CellAverage, NaNReachesItsOwnPointsOnlyAndLargeValuesDoNotOverflow) {
    const std::vector<Tet> tets{{0, 1, 2, 3}, {1, 2, 3, 4}};
    const MeshScalar mean = average_to_points(6, tets, {"c", {std::nan(""), 1e308}});
    for (std::size_t i = 0; i < 4; ++i) EXPECT_TRUE(std::isnan(mean.values[i]));
    EXPECT_EQ(mean.values[4], 1e308);
    EXPECT_EQ(mean.values[5], 1e308);
    EXPECT_EQ(average_to_points(4, std::span(tets).first(1), {"c", {1.7e308}}).values[0], 1.7e308);
    const MeshScalar two = average_to_points(5, tets, {"c", {1.7e308, 1.7e308}});
    for (const double value : two.values) EXPECT_EQ(value, 1.7e308);
}

// If all cubes of a grid are cut in the same way, the centre values of a linear field give the
// field back at inner points: the tets on one side of a point mirror those on the other.
TEST(CellAverage, KeepsALinearFieldInsideARegularGrid) {
    constexpr int side = 4;
    const auto at = [](int x, int y, int z) {
        return static_cast<std::int32_t>(x + side * (y + side * z));
    };
    constexpr int steps[6][3] = {{1, 2, 4}, {1, 4, 2}, {2, 1, 4}, {2, 4, 1}, {4, 1, 2}, {4, 2, 1}};
    std::vector<Tet> tets;
    MeshScalar centres{"f", {}};
    for (int cube = 0; cube < 27; ++cube) {
        const int x = cube % 3, y = cube / 3 % 3, z = cube / 9;
        for (const auto& step : steps) {  // the cubes of a Kuhn mesh
            Tet tet{at(x, y, z), 0, 0, 0};
            int bits = 0;
            double f = 4.0 * (2 * x - 3 * y + z);
            for (std::size_t i = 0; i < 3; ++i) {
                bits |= step[i];
                tet[i + 1] = at(x + (bits & 1), y + (bits >> 1 & 1), z + (bits >> 2));
                f += 2 * (bits & 1) - 3 * (bits >> 1 & 1) + (bits >> 2);
            }
            tets.push_back(tet);
            centres.values.push_back(f / 4);
        }
    }
    const MeshScalar mean = average_to_points(side * side * side, tets, centres);
    for (int z = 1; z < 3; ++z) {
        for (int y = 1; y < 3; ++y) {
            for (int x = 1; x < 3; ++x) {
                // 24 terms below 10, each rounded by some 1e-16 of that.
                EXPECT_NEAR(mean.values[static_cast<std::size_t>(at(x, y, z))], 2 * x - 3 * y + z,
                            24 * 10 * 2e-16);
            }
        }
    }
}

}  // namespace
}  // namespace lamina
