// SPDX-License-Identifier: Apache-2.0
#include "projection/screen_polygon.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>
#include <vector>

#include "scene/camera.h"

namespace lamina {
namespace {

// Returns how far a place lies inside the polygon (by its winding number); negative outside.
double depth_in(const ScreenPolygon& polygon, const glm::dvec2& place) {
    double nearest = INFINITY, turn = 0;
    for (int i = 0; i < polygon.count; ++i) {
        const glm::dvec2 a(polygon.corners[static_cast<std::size_t>(i)]);
        const glm::dvec2 b(polygon.corners[static_cast<std::size_t>((i + 1) % polygon.count)]);
        turn += std::atan2(cross(a - place, b - place), glm::dot(a - place, b - place));
        const glm::dvec2 along = b - a;
        const double square = glm::dot(along, along);
        const double share =
            square > 0 ? std::clamp(glm::dot(place - a, along) / square, 0.0, 1.0) : 0;
        nearest = std::min(nearest, glm::distance(place, a + share * along));
    }
    return turn > 3 ? nearest : -nearest;
}

// Expects corners on the rasteriser's grid of 256 steps a pixel, and only left turns between edges.
void expect_convex_on_grid(const ScreenPolygon& polygon) {
    for (int i = 0; i < polygon.count; ++i) {
        const auto corner = [&](int offset) {
            return glm::dvec2(
                polygon.corners[static_cast<std::size_t>((i + offset) % polygon.count)]);
        };
        EXPECT_EQ(corner(0), glm::round(corner(0) * 256.0) / 256.0);
        EXPECT_GT(cross(corner(1) - corner(0), corner(2) - corner(1)), 0);
    }
}

// Every point of the hull lies inside by the margin, except for the rounding of corners to the
// grid, by up to half a step in both coordinates, .71 of margin / 2. So it lies inside by more than
// half of the margin.
TEST(ScreenPolygon, SurroundsItsPoints) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(0, 1);
    constexpr double margin = 1.0 / 128;
    for (int trial = 0; trial < 20000; ++trial) {
        std::vector<glm::dvec2> points(3 + static_cast<std::size_t>(4 * uniform(random)));
        const double size = std::pow(10, 3 * uniform(random) - 1);
        const glm::dvec2 middle(800 * uniform(random), 600 * uniform(random));
        const double flatness = trial % 3 == 0 ? 1e-6 : 1;  // needles, too
        const double angle = 6.3 * uniform(random);
        for (glm::dvec2& point : points) {
            const double u = size * (uniform(random) - .5),
                         v = flatness * size * (uniform(random) - .5);
            point = middle + glm::dvec2(u * std::cos(angle) - v * std::sin(angle),
                                        u * std::sin(angle) + v * std::cos(angle));
        }
        const ScreenPolygon polygon = surround(points, margin, 800, 600);
        if (polygon.count == 0) continue;
        expect_convex_on_grid(polygon);
        for (int sample = 0; sample < 20; ++sample) {
            const auto i = static_cast<std::size_t>(uniform(random) * double(points.size()));
            const auto j = static_cast<std::size_t>(uniform(random) * double(points.size()));
            const glm::dvec2 place = points[i] + uniform(random) * (points[j] - points[i]);
            if (place.x < 0 || place.y < 0 || place.x > 800 || place.y > 600) continue;
            ASSERT_GE(depth_in(polygon, place), margin / 2) << trial;
        }
    }
}

TEST(ScreenPolygon, IsEmptyWithoutAPixelCenter) {
    const std::vector<glm::dvec2> between{{10.6, 10.6}, {11.4, 10.6}, {11, 11.4}};
    EXPECT_EQ(surround(between, 1.0 / 128, 800, 600).count, 0);
    const std::vector<glm::dvec2> outside{{-5, -5}, {-2, -5}, {-3, -1}};
    EXPECT_EQ(surround(outside, 1.0 / 128, 800, 600).count, 0);
    const std::vector<glm::dvec2> point{{10.5, 10.5}, {10.5, 10.5}, {10.5, 10.5}};
    EXPECT_GE(surround(point, 1.0 / 128, 800, 600).count, 3);
}

// A polygon that reaches far beyond the picture is cut, and still covers the same pixels of the
// picture.
TEST(ScreenPolygon, IsCutIfItIsHuge) {
    const std::vector<glm::dvec2> points{{-1e9, -1e9}, {1e9, -1e9}, {300, 400}};
    const ScreenPolygon polygon = surround(points, 1.0 / 128, 800, 600);
    ASSERT_GE(polygon.count, 3);
    EXPECT_GT(depth_in(polygon, {300, 399}), 0);
    EXPECT_GT(depth_in(polygon, {10, 1}), 0);
    for (int i = 0; i < polygon.count; ++i) {
        EXPECT_LE(std::abs(polygon.corners[static_cast<std::size_t>(i)].x), 900);
        EXPECT_LE(std::abs(polygon.corners[static_cast<std::size_t>(i)].y), 700);
    }
}

}  // namespace
}  // namespace lamina
