// SPDX-License-Identifier: Apache-2.0
#include "lamina/sampling.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/glm.hpp>
#include <limits>
#include <random>

#include "lamina/error.h"
#include "support/split_box.h"
#include "support/volume_of.h"

namespace lamina {
namespace {

const glm::dvec3 slope(1.5, -2, .25);

// A linear field with the value 3 at the origin.
double linear(const glm::dvec3& p) {
    return 3 + glm::dot(slope, p);
}

glm::dvec3 random_point(std::mt19937& random, const glm::dvec3& lowest, const glm::dvec3& highest) {
    std::uniform_real_distribution<double> share(0, 1);
    const glm::dvec3 at(share(random), share(random), share(random));
    return lowest + at * (highest - lowest);
}

// Returns a turned grid with the field of linear(). Its samples are multiples of 1/64 below 2^10,
// which float32 holds exactly.
Volume linear_volume(Centering centering) {
    Grid grid = test::grid_of({5, 4, 6}, centering);
    grid.origin = {1, -2, 3};
    grid.step = {glm::dvec3(0, .5, 0), glm::dvec3(-.25, 0, 0), glm::dvec3(0, 0, 2)};
    auto samples = std::make_shared<std::vector<float>>();
    for (int z = 0; z < 6; ++z)
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 5; ++x)
                samples->push_back(static_cast<float>(linear(grid.to_world({x, y, z}))));
    return {grid, SampleType::float32, {samples, samples->data()}};
}

// Coordinates are below 16 and slopes below 2: about 30 roundings of numbers below 64.
constexpr double tolerance = 30 * 64 * std::numeric_limits<double>::epsilon();

void expect_linear(const FieldSampler& field, const glm::dvec3& p) {
    const auto found = field.at(p);
    ASSERT_TRUE(found) << p.x << " " << p.y << " " << p.z;
    EXPECT_NEAR(found->value, linear(p), tolerance);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found->gradient[c], slope[c], tolerance);
}

TEST(Sampling, MatchesALinearFieldOnAVolume) {
    const Volume volume = linear_volume(Centering::node);
    const FieldSampler field(volume);
    const Grid::Bounds box = volume.grid().bounds();
    std::mt19937 random(1);
    for (int i = 0; i < 200; ++i) expect_linear(field, random_point(random, box.min, box.max));
    expect_linear(field, box.min);
    expect_linear(field, box.max);
}

TEST(Sampling, MatchesALinearFieldOnAMesh) {
    const FieldSampler field(test::kuhn_box({3, 2, 4}, linear));
    std::mt19937 random(2);
    for (int i = 0; i < 200; ++i)
        expect_linear(field, random_point(random, glm::dvec3(0), {3, 2, 4}));
    // Corners, faces, edges and points of the mesh, and its middle.
    for (const glm::dvec3& p : {glm::dvec3(0, 0, 0), glm::dvec3(3, 2, 4), glm::dvec3(1.5, 0, 2.25),
                                glm::dvec3(3, 0, 1), glm::dvec3(1, 1, 2), glm::dvec3(1.5, 1, 2)})
        expect_linear(field, p);
}

TEST(Sampling, FindsNothingOutsideTheData) {
    const FieldSampler volume(linear_volume(Centering::node));
    const FieldSampler mesh(test::kuhn_box({1, 1, 1}, linear));
    const glm::dvec3 no_place(std::numeric_limits<double>::quiet_NaN(), 0, 0);
    for (const glm::dvec3& p : {glm::dvec3(1.001, -1, 5), glm::dvec3(100, 0, 0), no_place})
        EXPECT_FALSE(volume.at(p));
    for (const glm::dvec3& p : {glm::dvec3(1.001, .5, .5), glm::dvec3(100, 0, 0), no_place})
        EXPECT_FALSE(mesh.at(p));
    // A point inside the mesh's bounding box but in no tet.
    MeshData one;
    one.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    one.tets = {{0, 1, 2, 3}};
    one.point_scalars = {{"scalar", {0, 1, 2, 3}}};
    EXPECT_TRUE(FieldSampler(one).at({.2, .2, .2}));
    EXPECT_FALSE(FieldSampler(one).at({.6, .6, .6}));
}

// On a `cell` axis the box is half a voxel longer at each end, where the border value is repeated.
TEST(Sampling, RepeatsTheBorderInHalfVoxels) {
    const Volume volume = linear_volume(Centering::cell);
    const Grid& grid = volume.grid();
    const FieldSampler field(volume);
    const auto beside = field.at(grid.to_world({-.4, 1.5, 2.5}));
    const auto border = field.at(grid.to_world({0, 1.5, 2.5}));
    ASSERT_TRUE(beside && border);
    EXPECT_NEAR(beside->value, border->value, tolerance);
    EXPECT_NEAR(glm::distance(beside->gradient, border->gradient), 0, tolerance);
    EXPECT_FALSE(field.at(grid.to_world({-.6, 1.5, 2.5})));
}

TEST(Sampling, IsNanInCellsWithANanCorner) {
    auto samples = std::make_shared<std::vector<float>>(27, 1.f);
    samples->front() = std::numeric_limits<float>::quiet_NaN();
    const FieldSampler field(Volume(test::grid_of({3, 3, 3}, Centering::node), SampleType::float32,
                                    {samples, samples->data()}));
    const glm::dvec3 step = {1, 1, 1};
    EXPECT_TRUE(std::isnan(field.at(.5 * step)->value));
    EXPECT_EQ(field.at(1.5 * step)->value, 1);
}

// Expects segments of a ray that follow each other from `begin` to `end` and whose bounds contain
// the field, one for each cell.
void expect_covered(const FieldSampler& field, const glm::dvec3& origin,
                    const glm::dvec3& direction, double begin, double end) {
    const std::vector<RaySegment> segments = field.along(origin, 3.0 * direction);
    ASSERT_FALSE(segments.empty());
    EXPECT_NEAR(segments.front().begin, begin, tolerance);
    EXPECT_NEAR(segments.back().end, end, tolerance);
    for (std::size_t i = 0; i < segments.size(); ++i) {
        const RaySegment& segment = segments[i];
        EXPECT_LT(segment.begin, segment.end);
        if (i > 0) {
            EXPECT_NEAR(segment.begin, segments[i - 1].end, tolerance);
        }
        for (const double share : {0., .3, 1.}) {
            const double t = segment.begin + share * (segment.end - segment.begin);
            EXPECT_GE(linear(origin + t * direction), segment.least - tolerance);
            EXPECT_LE(linear(origin + t * direction), segment.most + tolerance);
        }
    }
}

TEST(Sampling, FollowsARayThroughCellsAndTets) {
    // The grid's x axis points along the world's y axis: 4 cells of .5 from y = -2 on.
    const FieldSampler volume(linear_volume(Centering::node));
    const glm::dvec3 y(0, 1, 0);
    expect_covered(volume, {.7, -3, 5.5}, y, 1, 3);
    EXPECT_EQ(volume.along({.7, -3, 5.5}, y).size(), 4u);
    expect_covered(volume, {.7, -1.2, 5.5}, y, 0, 1.2);  // from inside
    EXPECT_TRUE(volume.along({.7, 3, 5.5}, y).empty());
    const FieldSampler mesh(test::kuhn_box({2, 2, 2}, linear));
    // The ray starts at x = -1 and crosses the box from 0 to 2.
    const glm::dvec3 slanted(1, .2, .3);
    const double length = glm::length(slanted);
    expect_covered(mesh, {-1, .45, .35}, slanted / length, length, 3 * length);
    EXPECT_TRUE(mesh.along({.5, .5, .5}, {0, 0, 0}).empty());
}

TEST(Sampling, RefusesScalarsThatTheMeshLacks) {
    EXPECT_THROW(FieldSampler(test::kuhn_box({1, 1, 1}, linear), "heat"), Error);
}

}  // namespace
}  // namespace lamina
