// SPDX-License-Identifier: Apache-2.0
#include "choice/choose.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "base/enum_words.h"
#include "choice/orientation.h"
#include "scene/camera.h"
#include "support/volume_of.h"

namespace lamina {
namespace {

constexpr int width = 300, height = 200;

// How far points reach in the picture to all four sides, in halves of its width and height.
struct Reach {
    double left = INFINITY, right = -INFINITY, down = INFINITY, up = -INFINITY;
    Reach(const std::vector<glm::dvec3>& points, const Camera& camera) {
        const View view(camera, width, height);
        for (const glm::dvec3& point : points) {
            const glm::dvec3 arm = point - view.eye;
            const double depth = glm::dot(arm, view.forward) * view.pixel / 2;
            const double x = glm::dot(arm, view.right) / (depth * width);
            const double y = glm::dot(arm, view.up) / (depth * height);
            left = std::min(left, x);
            right = std::max(right, x);
            down = std::min(down, y);
            up = std::max(up, y);
        }
    }
};

std::vector<glm::dvec3> cloud(unsigned seed, const glm::dvec3& size, const glm::dvec3& origin) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> share(0, 1);
    std::vector<glm::dvec3> points;
    for (int i = 0; i < 100; ++i)
        points.push_back(origin + size * glm::dvec3(share(random), share(random), share(random)));
    return points;
}

std::array<glm::dvec3, 8> box(const glm::dvec3& size) {
    std::array<glm::dvec3, 8> corners;
    for (unsigned corner = 0; corner < 8; ++corner)
        corners[corner] = size * glm::dvec3(corner & 1, corner >> 1 & 1, corner >> 2);
    return corners;
}

Orientation of_cube(WorldAxes axes, std::optional<UpAxis> up = {}) {
    return orientation_of(axes, box({1, 1, 1}), up);
}

Axes front_of(WorldAxes axes) {
    return of_cube(axes).front;
}

// Coordinates in the picture are quotients of sums of products. Each product has a rounding error
// of 1e-16 of the cloud's distance from the origin, which is at most 1e3 times the cloud's size:
// 1e-12 allows for 10 such errors.
constexpr double rounding = 1e-12;

TEST(FittedCamera, TwoOppositeEdgesTouchTheMargin) {
    for (unsigned seed = 0; seed < 50; ++seed) {
        const auto points =
            cloud(seed, {1, seed % 7 == 0 ? 40 : 2, seed % 5 == 0 ? .01 : 3}, {1000, -200, 0});
        const ViewTurn turn{37. * seed, 11. * seed};
        const Reach reach(points,
                          fitted_camera(points, front_of(WorldAxes::unnamed), turn, width, height));
        constexpr double edge = 1 - 1. / 25;
        EXPECT_LE(std::max({-reach.left, reach.right, -reach.down, reach.up}), edge + rounding);
        const bool sides =
            std::abs(reach.left + edge) < rounding && std::abs(reach.right - edge) < rounding;
        const bool ends =
            std::abs(reach.down + edge) < rounding && std::abs(reach.up - edge) < rounding;
        EXPECT_TRUE(sides || ends) << seed;
    }
}

// Columns from 0 to the width are places from -1 to 1 in the picture, and rows likewise.
TEST(FittedCamera, LeavesMarginsFree) {
    const PictureMargins margins{
        .left = 0.05 * width, .right = 0.3 * width, .top = 0.1 * height, .bottom = 0.2 * height};
    for (unsigned seed = 0; seed < 50; ++seed) {
        const auto points =
            cloud(seed, {1, seed % 7 == 0 ? 40 : 2, seed % 5 == 0 ? .01 : 3}, {1000, -200, 0});
        const ViewTurn turn{37. * seed, 11. * seed};
        const Camera camera = fitted_camera(points, front_of(WorldAxes::unnamed), turn, width,
                                            height, false, margins);
        const Reach reach(points, camera);
        constexpr double inner = 1 - 1. / 25;
        // The free part reaches from -.9 to .4, and from -.6 to .8.
        const double left = -0.25 - 0.65 * inner, right = -0.25 + 0.65 * inner;
        const double down = 0.1 - 0.7 * inner, up = 0.1 + 0.7 * inner;
        EXPECT_GE(reach.left, left - rounding);
        EXPECT_LE(reach.right, right + rounding);
        EXPECT_GE(reach.down, down - rounding);
        EXPECT_LE(reach.up, up + rounding);
        const bool sides =
            std::abs(reach.left - left) < rounding && std::abs(reach.right - right) < rounding;
        const bool ends =
            std::abs(reach.down - down) < rounding && std::abs(reach.up - up) < rounding;
        EXPECT_TRUE(sides || ends) << seed;
    }
}

// A camera turned by any angle about its up has all points in its picture, and at one of 720 angles
// two opposite edges are almost touched. A point is farthest out at an angle at most 1/4 degree
// from one of these, where it is nearer to the middle by at most 1 - cos(1/4 degree) = 1e-5 of its
// distance from the axis. In the picture this is at most 1e-5 * 40 of the width, because clouds are
// at most 40 times as high as wide.
TEST(FittedCamera, HoldsAllPointsInEveryViewOfATurntable) {
    for (unsigned seed = 0; seed < 50; ++seed) {
        const auto points =
            cloud(seed, {1, seed % 7 == 0 ? 40 : 2, seed % 5 == 0 ? .01 : 3}, {1000, -200, 0});
        const ViewTurn turn{37. * seed, 3. * seed - 80};
        const WorldAxes axes =
            seed % 2 == 0 ? WorldAxes::unnamed : WorldAxes::left_posterior_superior;
        const Camera camera = fitted_camera(points, front_of(axes), turn, width, height, true);
        constexpr double edge = 1 - 1. / 25;
        double most = 0;
        for (int view = 0; view < 720; ++view) {
            const Reach reach(points, turned(camera, 0.5 * view));
            most = std::max({most, -reach.left, reach.right, -reach.down, reach.up});
        }
        EXPECT_LE(most, edge + rounding) << seed;
        EXPECT_GE(most, edge - 4e-4) << seed;
    }
}

glm::dvec3 toward_eye(WorldAxes axes) {
    const std::vector<glm::dvec3> points{{0, 0, 0}, {1, 1, 1}};
    const Orientation from = of_cube(axes);
    const ViewTurn turn = turn_to(ViewSide::iso, from);
    const Camera camera = fitted_camera(points, from.front, turn, width, height);
    return glm::normalize(camera.eye - camera.center);
}

TEST(FittedCamera, LooksAtPatientsFromInFrontWithTheHeadUp) {
    // Anterior is -y in LPS and +y in the other axes; the patient's left is +x in LPS and LAS and
    // -x in RAS.
    const double degree = std::acos(-1.) / 180;
    const glm::dvec3 lps(std::sin(30 * degree) * std::cos(20 * degree),
                         -std::cos(30 * degree) * std::cos(20 * degree), std::sin(20 * degree));
    const auto near = [](const glm::dvec3& a, const glm::dvec3& b) {
        return glm::distance(a, b) < 1e-14;  // a few roundings of numbers below 1
    };
    EXPECT_TRUE(near(toward_eye(WorldAxes::left_posterior_superior), lps));
    EXPECT_TRUE(near(toward_eye(WorldAxes::right_anterior_superior), {-lps.x, -lps.y, lps.z}));
    EXPECT_TRUE(near(toward_eye(WorldAxes::left_anterior_superior), {lps.x, -lps.y, lps.z}));
    EXPECT_TRUE(near(toward_eye(WorldAxes::unnamed), {lps.x, lps.z, -lps.y}));
}

// The rule of docs/first-picture.md: patients, then names of axes, then the longest axis.
TEST(Orientation, FollowsTheFileThenTheLongestAxis) {
    const auto up = [](WorldAxes axes, const glm::dvec3& size) {
        return orientation_of(axes, box(size)).front.up;
    };
    const glm::dvec3 y(0, 1, 0), z(0, 0, 1);
    EXPECT_EQ(up(WorldAxes::left_posterior_superior, {9, 1, 1}), z);
    EXPECT_EQ(up(WorldAxes::named, {9, 1, 1}), z);
    EXPECT_EQ(up(WorldAxes::unnamed, {1, 1, 1.26}), z);
    EXPECT_EQ(up(WorldAxes::unnamed, {1.26, 1, 1}), y);  // what is wide lies level
    EXPECT_EQ(up(WorldAxes::unnamed, {1, 1.26, 1}), y);
    EXPECT_EQ(up(WorldAxes::unnamed, {1, 1, 1.24}), y);
    EXPECT_EQ(up(WorldAxes::unnamed, {2, 1, 2}), y);
    EXPECT_NE(orientation_of(WorldAxes::unnamed, box({1, 1, 2})).reason.find("z, the longest"),
              std::string::npos);
}

TEST(Orientation, WhatIsFlatIsSeenFromAbove) {
    const auto side = [](WorldAxes axes, const glm::dvec3& size) {
        const ViewTurn turn = turn_to(ViewSide::iso, orientation_of(axes, box(size)));
        return std::pair(turn.azimuth, turn.elevation);
    };
    EXPECT_EQ(side(WorldAxes::named, {5, 6, .99}), std::pair(0., 90.));
    EXPECT_EQ(side(WorldAxes::named, {5, 6, 1.01}), std::pair(30., 20.));
    EXPECT_EQ(side(WorldAxes::unnamed, {5, 6, .5}), std::pair(30., 20.));
}

// The signs of CT and MR slices, and what lacks one of them.
TEST(Orientation, TheHeadOfAxialSlicesIsUp) {
    struct Slices {
        SampleType type = SampleType::int16;
        std::array<std::int64_t, 3> size{8, 8, 6};
        glm::dvec3 spacing{30, 30, 20};
        WorldAxes axes = WorldAxes::unnamed;
        const char* unit = "";
    };
    const auto up = [](const Slices& slices) {
        Grid grid = test::grid_of(slices.size, Centering::node);
        for (int axis = 0; axis < 3; ++axis) {
            grid.step[static_cast<std::size_t>(axis)] = glm::dvec3(0);
            grid.step[static_cast<std::size_t>(axis)][axis] = slices.spacing[axis];
        }
        grid.axes = slices.axes;
        grid.unit = slices.unit;
        const auto samples = std::make_shared<std::vector<float>>(8 * 8 * 8);
        const Volume volume(grid, slices.type,
                            std::shared_ptr<const void>(samples, samples->data()));
        const MinMaxBricks bricks = measure_bricks(volume);
        const VolumeField field(volume, bricks);
        return orientation_of(field.axes(), field.corners(), {}, field.axial_slices()).front.up;
    };
    const glm::dvec3 head(0, 0, -1);
    EXPECT_EQ(up({}), head);
    EXPECT_NE(up({.type = SampleType::float32}), head);
    EXPECT_NE(up({.size = {8, 7, 6}}), head);
    EXPECT_NE(up({.spacing = {30, 30, 30}}), head);  // any volume
    EXPECT_NE(up({.spacing = {.2, .2, .5}}), head);  // of a microscope
    EXPECT_NE(up({.spacing = {30, 30, 5}}), head);   // flat
    EXPECT_NE(up({.axes = WorldAxes::named}), head);
    EXPECT_EQ(up({.unit = "mm"}), head);
    EXPECT_NE(up({.unit = "um"}), head);  // of a microscope
}

TEST(Orientation, EveryAxisCanBeUpAndFrontsAreRightHanded) {
    for (const auto& [word, axis] : enum_words<UpAxis>()) {
        glm::dvec3 up(0);
        up[word[1] - 'x'] = word[0] == '+' ? 1 : -1;
        for (const WorldAxes world :
             {WorldAxes::unnamed, WorldAxes::named, WorldAxes::right_anterior_superior}) {
            const Orientation from = of_cube(world, axis);
            EXPECT_EQ(from.front.up, up) << word;
            EXPECT_EQ(glm::cross(from.front.right, from.front.up), from.front.toward) << word;
            EXPECT_NE(from.reason.find(word), std::string::npos);
        }
    }
    // As in ParaView: with +z up the eye is at -y.
    EXPECT_EQ(of_cube(WorldAxes::unnamed, UpAxis::plus_z).front.toward, glm::dvec3(0, -1, 0));
    EXPECT_EQ(of_cube(WorldAxes::unnamed, UpAxis::plus_y).front.toward, glm::dvec3(0, 0, 1));
    // A patient upside down is still seen from in front (+y in RAS).
    const Orientation head = of_cube(WorldAxes::right_anterior_superior, UpAxis::minus_z);
    EXPECT_EQ(head.front.toward, glm::dvec3(0, 1, 0));
    const auto left = turned(head.front, turn_to(ViewSide::left, head)).toward;
    EXPECT_NEAR(left.x, -1, 1e-15);  // the patient's left
    EXPECT_FALSE(of_cube(WorldAxes::right_anterior_superior, UpAxis::plus_y).patient);
}

TEST(Orientation, ViewsLookAtTheirSides) {
    const Orientation from = of_cube(WorldAxes::named);  // right x, up z, front -y
    const auto toward = [&](ViewSide side) {
        return turned(from.front, turn_to(side, from)).toward;
    };
    const auto near = [](const glm::dvec3& a, const glm::dvec3& b) {
        return glm::distance(a, b) < 1e-15;
    };
    EXPECT_TRUE(near(toward(ViewSide::front), {0, -1, 0}));
    EXPECT_TRUE(near(toward(ViewSide::back), {0, 1, 0}));
    EXPECT_TRUE(near(toward(ViewSide::left), {-1, 0, 0}));
    EXPECT_TRUE(near(toward(ViewSide::right), {1, 0, 0}));
    EXPECT_TRUE(near(toward(ViewSide::top), {0, 0, 1}));
    EXPECT_TRUE(near(toward(ViewSide::bottom), {0, 0, -1}));
    // The left of a patient is +x in LPS.
    const Orientation patient = of_cube(WorldAxes::left_posterior_superior);
    EXPECT_TRUE(near(turned(patient.front, turn_to(ViewSide::left, patient)).toward, {1, 0, 0}));
}

// Expects the axes of a camera that looks straight at a slice.
void expect_seen(const std::optional<Orientation>& found, const glm::dvec3& right,
                 const glm::dvec3& up) {
    ASSERT_TRUE(found);
    EXPECT_LT(glm::distance(found->front.right, right), 1e-14) << found->reason;
    EXPECT_LT(glm::distance(found->front.up, up), 1e-14) << found->reason;
    EXPECT_LT(glm::distance(found->front.toward, glm::cross(right, up)), 1e-14);
    const ViewTurn turn = turn_to(ViewSide::iso, *found);
    EXPECT_EQ(std::pair(turn.azimuth, turn.elevation), std::pair(0., 0.));
}

TEST(Orientation, OneSliceIsSeenAsAPicture) {
    const glm::dvec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
    for (const WorldAxes axes : {WorldAxes::unnamed, WorldAxes::named}) {
        expect_seen(orientation_of_slice({x, y}, axes), x, -y);
        expect_seen(orientation_of_slice({3. * x, z}, axes), x, -z);
        expect_seen(orientation_of_slice({y, .5 * z}, axes), y, -z);
        expect_seen(orientation_of_slice({x, y + .5 * x}, axes), x, -y);  // sheared
    }
    const auto asked = [&](UpAxis up) {
        return orientation_of_slice({x, y}, WorldAxes::unnamed, up);
    };
    expect_seen(asked(UpAxis::plus_y), x, y);
    expect_seen(asked(UpAxis::minus_y), x, -y);
    expect_seen(asked(UpAxis::plus_x), y, x);
    expect_seen(asked(UpAxis::minus_x), y, -x);
    EXPECT_FALSE(asked(UpAxis::plus_z));
}

// Axial slices are seen from the feet, coronal ones from in front, sagittal ones from the left,
// however the file stores them.
TEST(Orientation, OneSliceOfAPatientIsSeenAsRadiologistsDo) {
    const glm::dvec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
    const WorldAxes lps = WorldAxes::left_posterior_superior;
    const WorldAxes ras = WorldAxes::right_anterior_superior;
    for (const double sign : {1., -1.}) {
        expect_seen(orientation_of_slice({sign * x, y}, lps), x, -y);
        expect_seen(orientation_of_slice({y, sign * x}, ras), -x, y);
        expect_seen(orientation_of_slice({x, sign * z}, lps), x, z);
        expect_seen(orientation_of_slice({sign * x, z}, ras), -x, z);
        expect_seen(orientation_of_slice({y, sign * z}, lps), y, z);
        expect_seen(orientation_of_slice({y, sign * z}, ras), -y, z);
    }
    // An oblique slice is not turned in its plane.
    const glm::dvec3 tilted = glm::normalize(y + .3 * z);
    expect_seen(orientation_of_slice({x, tilted}, lps), x, -tilted);
}

TEST(TurnedCamera, GoesAroundItsCenter) {
    Camera camera;
    camera.eye = {0, 0, 5};
    camera.center = {0, 0, 1};
    const Camera right = turned(camera, ViewTurn{90, 0});
    EXPECT_LT(glm::distance(right.eye, {4, 0, 1}), 1e-15);
    const Camera above = turned(camera, ViewTurn{0, 90});
    EXPECT_LT(glm::distance(above.eye, {0, 4, 1}), 1e-15);
    EXPECT_LT(glm::distance(above.up, {0, 0, -1}), 1e-15);
    EXPECT_EQ(turned(camera, ViewTurn{}).eye, camera.eye);  // bit for bit
}

// Its `up` stays, so that a turntable goes about the axis that was up before.
TEST(TurnedCamera, KeepsItsUpUnlessItCrossesAPole) {
    Camera camera;
    camera.eye = {0, -5, 1};
    camera.center = {0, 0, 1};
    camera.up = {0, 0, 2};
    EXPECT_EQ(turned(camera, ViewTurn{25, 40}).up, camera.up);
    EXPECT_EQ(turned(camera, ViewTurn{25, -80}).up, camera.up);
    const Camera beyond = turned(camera, ViewTurn{0, 120});
    EXPECT_LT(glm::distance(beyond.up, {0, std::sin(2 * std::acos(-1.) / 3), -.5}), 1e-15);
}

TEST(ZoomedCamera, EnlargesThePicture) {
    Camera camera;
    camera.fov_y = 90;
    EXPECT_NEAR(zoomed(camera, 2).fov_y, 2 * std::atan(.5) * 180 / std::acos(-1.), 1e-13);
    EXPECT_EQ(zoomed(camera, 2).height, camera.height / 2);
    EXPECT_EQ(zoomed(camera, 1).fov_y, 90);
}

}  // namespace
}  // namespace lamina
