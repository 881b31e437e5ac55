// SPDX-License-Identifier: Apache-2.0
#include "slicing/slab_geometry.h"

#include <gtest/gtest.h>

#include <glm/common.hpp>
#include <random>

#include "support/volume_of.h"

namespace lamina {
namespace {

constexpr int picture_width = 64, picture_height = 48;

// Tells whether the ray through a pixel's centre meets the box in front of the eye.
bool meets(const IndexBox& box, const Grid& grid, const View& view, int column, int row) {
    const View::Ray ray = view.ray(column, row);
    const glm::dvec3 origin = grid.to_index(ray.origin);
    const glm::dvec3 direction = grid.direction_to_index(ray.direction);
    double enter = 0, leave = 1e300;
    for (int axis = 0; axis < 3; ++axis) {
        const double one = (box.min[axis] - origin[axis]) / direction[axis];
        const double other = (box.max[axis] - origin[axis]) / direction[axis];
        enter = std::max(enter, std::min(one, other));
        leave = std::min(leave, std::max(one, other));
    }
    return enter < leave;
}

// Views from outside and inside, near and far.
TEST(PixelBox, HoldsAllPixelsWhoseRaysMeetTheBox) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform(0, 1);
    const auto point = [&](double from, double size) {
        return from + size * glm::dvec3(uniform(random), uniform(random), uniform(random));
    };
    const Grid grid = test::grid_of({20, 30, 10}, Centering::node);
    int smaller = 0;
    for (int i = 0; i < 300; ++i) {
        Camera camera;
        camera.projection = i % 3 == 0 ? Projection::orthographic : Projection::perspective;
        camera.eye = grid.to_world(point(-20, 60));
        camera.center = grid.to_world(point(0, 20));
        camera.height = 2 * uniform(random) + .1;
        const View view(camera, picture_width, picture_height);
        const glm::dvec3 one = point(0, 20), other = point(0, 20);
        const IndexBox box{glm::min(one, other), glm::max(one, other)};
        const PixelBox found = pixels_of(box, grid, view);
        smaller += found.first_column > 0 || found.end_column < picture_width;
        for (int row = 0; row < picture_height; ++row) {
            for (int column = 0; column < picture_width; ++column) {
                if (!meets(box, grid, view, column, row)) continue;
                EXPECT_TRUE(column >= found.first_column && column < found.end_column &&
                            row >= found.first_row && row < found.end_row);
            }
        }
    }
    EXPECT_GT(smaller, 100);
}

TEST(PixelBox, IsThePictureIfTheBoxSurroundsTheEye) {
    const Grid grid = test::grid_of({10, 10, 10}, Centering::node);
    Camera camera;
    camera.eye = grid.to_world(glm::dvec3(4.5));
    camera.center = grid.to_world(glm::dvec3(4.5, 4.5, 0));
    const PixelBox found = pixels_of({glm::dvec3(0), glm::dvec3(9)}, grid, View(camera, 64, 48));
    EXPECT_EQ(found.first_column, 0);
    EXPECT_EQ(found.end_column, 64);
    EXPECT_EQ(found.first_row, 0);
    EXPECT_EQ(found.end_row, 48);
}

}  // namespace
}  // namespace lamina
