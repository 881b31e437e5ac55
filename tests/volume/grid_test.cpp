// SPDX-License-Identifier: Apache-2.0
#include "lamina/volume.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

namespace lamina {
namespace {

Grid make_grid(std::array<std::int64_t, 3> size, Centering centering) {
    Grid grid;
    grid.size = size;
    grid.centering = {centering, centering, centering};
    return grid;
}

// Returns a grid that is rotated by 30 degrees about z, mirrored in z, and anisotropic.
Grid rotated_grid() {
    Grid grid = make_grid({5, 4, 3}, Centering::node);
    const double c = std::sqrt(0.75);
    const double s = 0.5;
    grid.step = {glm::dvec3{2 * c, 2 * s, 0}, glm::dvec3{-3 * s, 3 * c, 0}, glm::dvec3{0, 0, -0.5}};
    grid.origin = {10, -20, 5};
    return grid;
}

TEST(Grid, NodeBoxSpansTheSamples) {
    const Grid grid = make_grid({5, 4, 3}, Centering::node);
    EXPECT_EQ(grid.index_min(), glm::dvec3(0, 0, 0));
    EXPECT_EQ(grid.index_max(), glm::dvec3(4, 3, 2));
    EXPECT_EQ(grid.sample_count(), 60);
}

TEST(Grid, CellBoxReachesHalfAVoxelFarther) {
    const Grid grid = make_grid({5, 4, 3}, Centering::cell);
    EXPECT_EQ(grid.index_min(), glm::dvec3(-0.5));
    EXPECT_EQ(grid.index_max(), glm::dvec3(4.5, 3.5, 2.5));
}

TEST(Grid, SpansTheSamplesByDefault) {
    Grid grid;
    grid.size = {5, 4, 1};
    EXPECT_EQ(grid.index_min(), glm::dvec3(0, 0, -.5));
    EXPECT_EQ(grid.index_max(), glm::dvec3(4, 3, .5));
}

TEST(Grid, AxisWithOneSampleIsAlwaysAVoxel) {
    const Grid grid = make_grid({5, 1, 1}, Centering::node);
    EXPECT_EQ(grid.index_min(), glm::dvec3(0, -0.5, -0.5));
    EXPECT_EQ(grid.index_max(), glm::dvec3(4, 0.5, 0.5));
}

TEST(Grid, WorldAndIndexAreInverse) {
    const Grid grid = rotated_grid();
    const glm::dvec3 index{1.25, 2.5, -0.75};
    const glm::dvec3 world = grid.to_world(index);
    // 10 + 1.25*2c - 2.5*3s, -20 + 1.25*2s + 2.5*3c, 5 + 0.75*0.5
    const double c = std::sqrt(0.75);
    EXPECT_NEAR(world.x, 10 + 2.5 * c - 3.75,
                1e-13);  // a few roundings of numbers below 32: 1e-14 each
    EXPECT_NEAR(world.y, -20 + 1.25 + 7.5 * c, 1e-13);
    EXPECT_NEAR(world.z, 5.375, 1e-13);
    EXPECT_LT(glm::distance(grid.to_index(world), index), 1e-13);
    const glm::dvec3 direction = grid.direction_to_index(grid.step[0] - 2.0 * grid.step[2]);
    EXPECT_LT(glm::distance(direction, glm::dvec3(1, 0, -2)), 1e-13);
}

TEST(Grid, BoundsOfARotatedBoxHoldItsCornersTightly) {
    const Grid grid = rotated_grid();
    const Grid::Bounds bounds = grid.bounds();
    // x runs along 4*2c and back along 3*3s; y along both; z down by 2*0.5.
    const double c = std::sqrt(0.75);
    EXPECT_NEAR(bounds.min.x, 10 - 4.5, 1e-13);
    EXPECT_NEAR(bounds.max.x, 10 + 8 * c, 1e-13);
    EXPECT_NEAR(bounds.min.y, -20, 1e-13);
    EXPECT_NEAR(bounds.max.y, -20 + 4 + 9 * c, 1e-13);
    EXPECT_NEAR(bounds.min.z, 4, 1e-13);
    EXPECT_NEAR(bounds.max.z, 5, 1e-13);
}

}  // namespace
}  // namespace lamina
