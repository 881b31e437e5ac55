// SPDX-License-Identifier: Apache-2.0
// The polygons of slabs cover every pixel whose ray meets the slab inside the box, and none twice.
#include "slicing/slab_geometry.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "reference/fixtures.h"

namespace lamina {
namespace {

// Returns a number whose sign says on which side of the line a .. b a point lies.
double side(const SlabVertex& a, const SlabVertex& b, double x, double y) {
    return (double{b.column} - a.column) * (y - a.row) - (double{b.row} - a.row) * (x - a.column);
}

// Tells whether a point lies strictly inside a triangle. Pixel centres on an edge belong to one of
// its two triangles, by the rasteriser's rule.
bool inside(const SlabVertex* triangle, double x, double y) {
    const double one = side(triangle[0], triangle[1], x, y),
                 two = side(triangle[1], triangle[2], x, y),
                 three = side(triangle[2], triangle[0], x, y);
    return (one > 0 && two > 0 && three > 0) || (one < 0 && two < 0 && three < 0);
}

bool on_edge(const SlabVertex* triangle, double x, double y) {
    return side(triangle[0], triangle[1], x, y) * side(triangle[1], triangle[2], x, y) *
               side(triangle[2], triangle[0], x, y) ==
           0;
}

// Returns the length, in units of depth, of the ray's part inside box and slab.
double overlap(const View::Ray& ray, const IndexBox& box, double front, double back) {
    for (int axis = 0; axis < 3; ++axis) {
        const double a = (box.min[axis] - ray.origin[axis]) / ray.direction[axis];
        const double b = (box.max[axis] - ray.origin[axis]) / ray.direction[axis];
        front = std::max(front, std::min(a, b));
        back = std::min(back, std::max(a, b));
    }
    return back - front;
}

TEST(SlabPolygons, CoverWhatTheRaysMeetExactlyOnce) {
    const Grid grid = reference_test::make_grid({5, 5, 5}, Centering::node);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> place(-6, 10), low(0, 2), high(2.1, 4);
    int covered = 0;
    for (int trial = 0; trial < 300; ++trial) {
        Camera camera;
        camera.projection = trial % 3 == 0 ? Projection::orthographic : Projection::perspective;
        camera.eye = {place(random), place(random), place(random)};
        if (trial % 7 == 0) camera.eye = {low(random), low(random), high(random)};  // inside
        camera.center = {2.1, 1.9, 2.2};
        camera.fov_y = 20 + 13 * (trial % 11);
        camera.height = 6;
        camera.up = {.1, 1, .2};
        const View view(camera, 24, 18);
        const DepthRange depth = depth_range(grid, view);
        const Slabs slabs{depth.near, depth.far, 1 + trial % 9};
        const IndexBox box{{low(random), low(random), low(random)},
                           {high(random), high(random), high(random)}};
        for (int slab = 0; slab < slabs.count; ++slab) {
            std::vector<SlabVertex> all, triangles;
            append_slab_polygons(view, grid, box, slabs, Order::front_to_back, all);
            for (std::size_t i = 0; i < all.size(); i += 3) {
                if (all[i].slab == static_cast<float>(slab))
                    triangles.insert(triangles.end(), all.begin() + i, all.begin() + i + 3);
            }
            for (int row = 0; row < view.height; ++row) {
                for (int column = 0; column < view.width; ++column) {
                    int times = 0;
                    bool edge = false;
                    for (std::size_t i = 0; i < triangles.size(); i += 3) {
                        times += inside(&triangles[i], column + .5, row + .5);
                        edge = edge || on_edge(&triangles[i], column + .5, row + .5);
                    }
                    EXPECT_LE(times, 1);
                    const bool met = overlap(view.ray(column, row), box, slabs.depth(slab),
                                             slabs.depth(slab + 1)) > 1e-9;
                    if (met && !edge) {
                        EXPECT_EQ(times, 1) << "trial " << trial << ", slab " << slab;
                    }
                    covered += met;
                }
            }
        }
    }
    EXPECT_GT(covered, 10000);
}

// Corners lie on the rasteriser's grid of 1/256 pixel and form a strictly convex polygon, so the
// rasteriser neither moves them nor makes triangles overlap.
TEST(SlabPolygons, AreStrictlyConvexOnTheRasterisersGrid) {
    const Grid grid = reference_test::make_grid({40, 35, 11}, Centering::cell, {.3, .3, 1.1});
    std::mt19937 random(11);
    std::uniform_real_distribution<double> place(-1, 1);
    for (int trial = 0; trial < 200; ++trial) {
        const auto projection = trial % 2 == 0 ? Projection::orthographic : Projection::perspective;
        const View view(reference_test::camera_at(
                            grid, projection, {place(random), place(random), place(random)}, 1.3),
                        160, 120);
        const DepthRange depth = depth_range(grid, view);
        std::vector<SlabVertex> triangles;
        append_slab_polygons(view, grid, {grid.index_min(), grid.index_max()},
                             {depth.near, depth.far, 301}, Order::front_to_back, triangles);
        ASSERT_FALSE(triangles.empty());
        for (std::size_t i = 0; i < triangles.size(); i += 3) {
            const SlabVertex *const a = &triangles[i], *const b = a + 1, *const c = a + 2;
            EXPECT_GT(side(*a, *b, c->column, c->row), 0);
            const bool same_fan = i > 0 && a->slab == triangles[i - 3].slab;
            if (same_fan) {
                EXPECT_GT(side(triangles[i - 2], *b, c->column, c->row), 0);  // the turn at b
            }
            for (const SlabVertex* const corner : {a, b, c}) {
                EXPECT_EQ(corner->column * 256, std::round(corner->column * 256));
                EXPECT_EQ(corner->row * 256, std::round(corner->row * 256));
            }
        }
    }
}

TEST(SlabPolygons, ComeInTheOrderAskedFor) {
    const Grid grid = reference_test::make_grid({5, 5, 5}, Centering::node);
    const View view(reference_test::camera_at(grid, Projection::perspective, {1, .3, .5}, 1.5), 32,
                    32);
    const DepthRange depth = depth_range(grid, view);
    const Slabs slabs{depth.near, depth.far, 12};
    for (const Order order : {Order::back_to_front, Order::front_to_back}) {
        std::vector<SlabVertex> triangles;
        append_slab_polygons(view, grid, {grid.index_min(), grid.index_max()}, slabs, order,
                             triangles);
        for (std::size_t i = 3; i < triangles.size(); i += 3) {
            const float step = triangles[i].slab - triangles[i - 3].slab;
            EXPECT_GE(order == Order::front_to_back ? step : -step, 0);
        }
    }
}

}  // namespace
}  // namespace lamina
