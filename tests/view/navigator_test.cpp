// SPDX-License-Identifier: Apache-2.0
#include "model/navigator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <vector>

namespace lamina::view {
namespace {

// Bound for rounding: coordinates are about 10, and a few operations lose about 1e-15 each.
constexpr double rounding = 1e-12;

void expect_near(const glm::dvec3& a, const glm::dvec3& b, double tolerance = rounding) {
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(a[axis], b[axis], tolerance);
}

std::vector<Camera> cameras() {
    Camera camera;
    camera.eye = {3, -2, 5};
    camera.center = {.5, 1, -1};
    camera.up = {.1, 1, .2};
    camera.fov_y = 35;
    camera.height = 2.5;
    Camera flat = camera;
    flat.projection = Projection::orthographic;
    return {camera, flat};
}

double distance_of(const Camera& camera) {
    return glm::length(camera.eye - camera.center);
}

// Returns the place of a point in the picture, from its middle, to the right and up, in heights of
// the picture.
glm::dvec2 place_of(const Camera& camera, const glm::dvec3& point) {
    const ViewAxes axes = axes_of(camera);
    const glm::dvec3 from_eye = point - camera.eye;
    const double height =
        camera.projection == Projection::orthographic
            ? camera.height
            : 2 * glm::dot(from_eye, axes.forward) * std::tan(glm::radians(camera.fov_y) / 2);
    return {glm::dot(from_eye, axes.right) / height, glm::dot(from_eye, axes.up) / height};
}

glm::dvec3 point_at_center(const Camera& camera, const glm::dvec2& place) {
    const ViewAxes axes = axes_of(camera);
    return camera.center + height_at_center(camera) * (place.x * axes.right + place.y * axes.up);
}

TEST(Navigator, OrbitKeepsCenterAndDistance) {
    for (Camera camera : cameras()) {
        const Camera first = camera;
        for (int i = 0; i < 500; ++i) camera = orbited(camera, {.013, i % 2 ? .02 : -.017});
        EXPECT_EQ(camera.center, first.center);
        EXPECT_EQ(camera.up, first.up);
        EXPECT_NEAR(distance_of(camera), distance_of(first), 500 * rounding);
    }
}

// A drag over the picture's whole height turns by 180 degrees; a quarter of it by 45.
TEST(Navigator, OrbitTurnsBy180DegreesAcrossThePicture) {
    for (const Camera& camera : cameras()) {
        // A drag to the left moves the eye to the right.
        const Camera turned_by = orbited(camera, {-.25, 0});
        expect_near(turned_by.eye, turned(camera, 45).eye);
        const Camera back = orbited(orbited(camera, {0, .1}), {0, -.1});
        expect_near(back.eye, camera.eye);
    }
}

TEST(Navigator, OrbitStopsOneDegreeFromThePoles) {
    for (const Camera& camera : cameras()) {
        for (const double way : {-3.0, 3.0}) {
            const Camera next = orbited(camera, {.2, way});
            const double cosine =
                glm::dot(glm::normalize(next.eye - next.center), glm::normalize(next.up));
            EXPECT_NEAR(std::abs(cosine), std::cos(glm::radians(1.)), rounding);
        }
    }
}

// The point that is dragged or zoomed at stays under the pointer.
TEST(Navigator, PanAndZoomKeepThePointUnderThePointer) {
    const glm::dvec2 place(.31, -.22), drag(.1, .05);
    for (const Camera& camera : cameras()) {
        const glm::dvec3 point = point_at_center(camera, place);
        const glm::dvec2 panned_to = place_of(panned(camera, drag), point);
        EXPECT_NEAR(panned_to.x, place.x + drag.x, rounding);
        EXPECT_NEAR(panned_to.y, place.y + drag.y, rounding);
        for (const double factor : {.25, 1.7}) {
            const Camera next = zoomed(camera, factor, place);
            EXPECT_NEAR(height_at_center(next), factor * height_at_center(camera), rounding);
            EXPECT_NEAR(place_of(next, point).x, place.x, rounding);
            EXPECT_NEAR(place_of(next, point).y, place.y, rounding);
        }
    }
}

TEST(Navigator, LookAtBringsAPointToTheMiddle) {
    for (const Camera& camera : cameras()) {
        for (const glm::dvec3 point : {glm::dvec3(0, 0, 0), glm::dvec3(4, 3, -2)}) {
            const Camera next = looking_at(camera, point);
            EXPECT_EQ(next.center, point);
            EXPECT_NEAR(glm::length(place_of(next, point)), 0, rounding);
            if (camera.projection == Projection::perspective)
                EXPECT_EQ(next.eye, camera.eye);
            else
                EXPECT_NEAR(distance_of(next), distance_of(camera), rounding);
        }
    }
    Camera above = cameras()[0];  // looking straight down, along `up`, works, too
    const Camera down = looking_at(above, above.eye - glm::normalize(above.up));
    EXPECT_TRUE(std::isfinite(axes_of(down).right.x));
}

// All corners of the box are in the picture, and one of them touches the picture's edge.
TEST(Navigator, FitShowsAllOfABox) {
    const Grid::Bounds box{{-1, 0, 2}, {4, 2, 9}};
    for (const Camera& camera : cameras()) {
        for (const double aspect : {.5, 1.6}) {
            const Camera next = fitted(camera, box, aspect);
            double largest = 0;
            for (int corner = 0; corner < 8; ++corner) {
                const glm::dvec3 point(corner & 1 ? 4 : -1, corner & 2 ? 2 : 0, corner & 4 ? 9 : 2);
                EXPECT_GT(glm::dot(point - next.eye, axes_of(next).forward), 0);
                const glm::dvec2 place = place_of(next, point);
                largest =
                    std::max({largest, 2 * std::abs(place.x) / aspect, 2 * std::abs(place.y)});
            }
            EXPECT_NEAR(largest, 1, rounding);
            expect_near(axes_of(next).forward, axes_of(camera).forward);
        }
    }
}

TEST(Navigator, AxisViewsLookAlongAxes) {
    const Grid::Bounds box{{-1, 0, 2}, {4, 2, 9}};
    for (const Camera& camera : cameras()) {
        for (int axis = 0; axis < 3; ++axis) {
            for (const double sign : {-1., 1.}) {
                glm::dvec3 from(0);
                from[axis] = sign;
                const Camera next = seen_from(camera, from, box, 1.3);
                expect_near(axes_of(next).forward, -from);
                expect_near(axes_of(next).up,
                            axis == 2 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1));
                expect_near(next.center, {1.5, 1, 5.5});
            }
        }
    }
}

TEST(Navigator, ChangingTheProjectionKeepsTheSize) {
    for (const Camera& camera : cameras()) {
        const Projection other = camera.projection == Projection::perspective
                                     ? Projection::orthographic
                                     : Projection::perspective;
        const Camera next = with_projection(camera, other);
        EXPECT_EQ(next.projection, other);
        EXPECT_NEAR(height_at_center(next), height_at_center(camera), rounding);
        // An orthographic eye may move, so going back is expected to keep the eye of `next`.
        expect_near(with_projection(next, camera.projection).eye,
                    camera.projection == Projection::perspective ? camera.eye : next.eye);
    }
}

TEST(Navigator, FlyGoesAlongTheViewsAxes) {
    const std::vector<Camera> both = cameras();
    const ViewAxes axes = axes_of(both[0]);
    const Camera next = flown(both[0], {1, 2, 3});
    expect_near(next.eye - both[0].eye, 1. * axes.right + 2. * axes.up + 3. * axes.forward);
    expect_near(next.center - next.eye, both[0].center - both[0].eye);
    EXPECT_LT(flown(both[1], {0, 0, 1}).height, both[1].height);
}

}  // namespace
}  // namespace lamina::view
