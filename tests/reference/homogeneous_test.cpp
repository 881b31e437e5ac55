// SPDX-License-Identifier: Apache-2.0
// In a volume of one value alpha must be 1 - exp(-extinction * chord), whatever the grid, the
// camera and the cells.
#include <gtest/gtest.h>

#include "fixtures.h"
#include "reference/chord.h"

namespace lamina {
namespace {

using namespace reference_test;

// Returns the chord through an oriented box, computed along the box's axes in world space and in
// extended precision, with nothing shared with chord.cpp.
double independent_chord(const Grid& grid, const View::Ray& ray) {
    long double from = 0, to = std::numeric_limits<long double>::infinity();
    long double square = 0;
    for (int i = 0; i < 3; ++i) {
        square += static_cast<long double>(ray.direction[i]) * ray.direction[i];
    }
    for (int axis = 0; axis < 3; ++axis) {
        long double position = 0, slope = 0, norm = 0;
        for (int i = 0; i < 3; ++i) {
            const long double s = grid.step[axis][i];
            position += (static_cast<long double>(ray.origin[i]) - grid.origin[i]) * s;
            slope += ray.direction[i] * s;
            norm += s * s;
        }
        const long double lo = grid.index_min()[axis] * norm, hi = grid.index_max()[axis] * norm;
        if (slope == 0) {
            if (position < lo || position > hi) return 0;
            continue;
        }
        const long double a = (lo - position) / slope, b = (hi - position) / slope;
        from = std::max(from, std::min(a, b));
        to = std::min(to, std::max(a, b));
    }
    return from < to ? static_cast<double>((to - from) * std::sqrt(square)) : 0.0;
}

void expect_exact_opacity(const Grid& grid, const Camera& camera, double extinction) {
    const glm::dvec3 color{0.25, 1, 3};
    const View view(camera, 29, 23);
    const Volume volume = make_volume<std::uint16_t>(
        grid, std::vector<std::uint16_t>(static_cast<std::size_t>(grid.sample_count()), 7));
    const TraceResult result =
        trace_volume(volume, constant_function(extinction, color), view, {1e-12});
    double longest = 0;
    for (int row = 0; row < view.height; ++row) {
        for (int column = 0; column < view.width; ++column) {
            const double chord = independent_chord(grid, view.ray(column, row));
            const double expected = -std::expm1(-extinction * chord);
            longest = std::max(longest, chord);
            const double* pixel = result.image.pixel(column, row);
            // Errors: some 10 roundings of the chord and of each cell's depth (damped by
            // exp(-depth) * depth <= 0.4), and early termination at 1e-15. Together they are below
            // 1e-13.
            ASSERT_NEAR(pixel[3], expected, 1e-13) << column << "," << row;
            for (int channel = 0; channel < 3; ++channel) {
                ASSERT_NEAR(pixel[channel], expected * color[channel], 1e-13 * color[channel]);
            }
        }
    }
    // The picture is not empty: rays pass through the middle of the box, or the eye is in it.
    const glm::dvec3 voxels = grid.index_max() - grid.index_min();
    double thinnest = diagonal_of(grid);
    for (int axis = 0; axis < 3; ++axis) {
        thinnest = std::min(thinnest, voxels[axis] * glm::length(grid.step[axis]));
    }
    EXPECT_GT(longest, 0.4 * thinnest);
}

std::vector<Grid> grids() {
    std::vector<Grid> result;
    result.push_back(make_grid({5, 5, 5}, Centering::node));
    result.push_back(make_grid({5, 6, 7}, Centering::cell));
    result.push_back(make_grid({64, 3, 2}, Centering::node, {0.03, 1.7, 0.9}));
    result.push_back(make_grid({1, 9, 9}, Centering::node));
    result.push_back(make_grid({1, 1, 1}, Centering::cell, {1, 2, 3}));
    result.push_back(make_grid({4, 1, 1}, Centering::cell));
    Grid rotated;
    rotated.size = {12, 20, 8};
    rotated.centering = {Centering::node, Centering::cell, Centering::node};
    rotated.origin = {-40, 3, 11};
    rotated.step = {glm::dvec3(1, 2, 2) / 7.0, glm::dvec3(2, 1, -2) / 9.0,
                    glm::dvec3(-2, 2, -1) / 3.0};
    result.push_back(rotated);
    return result;
}

TEST(Homogeneous, BoxesAreExactFromEverywhere) {
    for (const Grid& grid : grids()) {
        for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
            for (const glm::dvec3& direction :
                 {glm::dvec3(0, 0, 1), glm::dvec3(-1, 0, 0), glm::dvec3(1, 0, 1),
                  glm::dvec3(1, 1, 1), glm::dvec3(-0.3, 0.2, -0.9)}) {
                for (const double depth : {1e-4, 1.0, 30.0}) {
                    SCOPED_TRACE(testing::Message()
                                 << grid.size[0] << "x" << grid.size[1] << "x" << grid.size[2]
                                 << " from " << direction.x << "," << direction.y << ","
                                 << direction.z << " depth " << depth);
                    expect_exact_opacity(grid, camera_at(grid, projection, direction, 1.2),
                                         depth / diagonal_of(grid));
                }
            }
        }
    }
}

TEST(Homogeneous, BoxesAreExactFromInsideAndFromACorner) {
    for (const Grid& grid : grids()) {
        for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
            Camera camera = camera_at(grid, projection, {1, 2, 3}, 0.01);
            expect_exact_opacity(grid, camera, 2 / diagonal_of(grid));  // almost in the middle
            camera.eye = grid.to_world(grid.index_min());
            expect_exact_opacity(grid, camera, 2 / diagonal_of(grid));  // in a corner
        }
    }
}

TEST(Homogeneous, BoxesAreExactFromFarAway) {
    const Grid grid = make_grid({9, 8, 7}, Centering::node);
    Camera camera = camera_at(grid, Projection::perspective, {1, 2, 3}, 1e5);
    camera.fov_y = 5e-4;
    // independent_chord() rounds, too: 1e5 diagonals * 5e-20 (80-bit) is far below 1e-13.
    if (std::numeric_limits<long double>::digits < 64) GTEST_SKIP() << "no extended precision here";
    expect_exact_opacity(grid, camera, 3 / diagonal_of(grid));
}

TEST(Homogeneous, BoxesBehindTheEyeShowNothing) {
    const Grid grid = make_grid({4, 4, 4}, Centering::node);
    Camera camera = camera_at(grid, Projection::perspective, {1, 0, 0}, 2);
    camera.center = camera.eye + (camera.eye - camera.center);
    const TraceResult result =
        trace_volume(make_volume<std::uint8_t>(grid, std::vector<std::uint8_t>(64, 1)),
                     constant_function(1, glm::dvec3(1)), View(camera, 16, 16), {});
    EXPECT_EQ(largest_alpha(result.image), 0);
    EXPECT_EQ(result.segments, 0);
}

// Each cell on a ray is integrated exactly once, also if the ray lies in a plane between cells,
// along an edge, or goes through corners.
TEST(Homogeneous, DegenerateRaysCountEveryCellOnce) {
    const Grid grid = make_grid({5, 5, 5}, Centering::node);
    const Volume volume = make_volume<std::uint8_t>(grid, std::vector<std::uint8_t>(125, 1));
    struct Case {
        glm::dvec3 eye, center;
        double chord;
    };
    const Case cases[] = {
        {{-1, 2, 1.5}, {4, 2, 1.5}, 4},                 // in a plane between cells
        {{-1, 2, 3}, {4, 2, 3}, 4},                     // along an edge
        {{-1, 0, 4}, {4, 0, 4}, 4},                     // along the box's own edge
        {{-1, -1, -1}, {4, 4, 4}, 4 * std::sqrt(3.0)},  // through corners
        {{5, -1, 2}, {0, 4, 2}, 4 * std::sqrt(2.0)},    // through edges, in a plane
    };
    for (const Case& c : cases) {
        Camera camera;
        camera.projection = Projection::orthographic;
        camera.eye = c.eye;
        camera.center = c.center;
        camera.up = {0.1, 0.2, 1};
        const TraceResult result =
            trace_volume(volume, constant_function(0.3, glm::dvec3(1)), View(camera, 1, 1), {});
        EXPECT_NEAR(result.image.rgba[3], -std::expm1(-0.3 * c.chord), 1e-14);
        // Rounding of the direction may cut slivers off neighbours (at most 2 at each of 3 inner
        // corners).
        EXPECT_GE(result.segments, 4);
        EXPECT_LE(result.segments, 4 + 6);
    }
}

}  // namespace
}  // namespace lamina
