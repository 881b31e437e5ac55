// SPDX-License-Identifier: Apache-2.0
#include "annotation/world_lines.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>

#include "annotation/numbers.h"
#include "annotation/scale_bar.h"
#include "mesh/predicates.h"
#include "scene/camera.h"
#include "support/heard_warnings.h"

namespace lamina {
namespace {

Scene scene_of(const Camera& camera) {
    Scene scene;
    scene.camera = camera;
    scene.width = 640;
    scene.height = 480;
    return scene;
}

std::vector<Camera> cameras() {
    Camera turned;
    turned.eye = {3, -2, 5};
    turned.center = {0.4, 0.3, -0.2};
    turned.up = {0.1, 1, 0.3};
    Camera parallel = turned;
    parallel.projection = Projection::orthographic;
    parallel.height = 2.5;
    Camera small = turned;
    small.eye = small.center + 1e-6 * (small.eye - small.center);
    return {turned, parallel, small};
}

// Places of points as renderers compute them.
glm::dvec2 seen(const Scene& scene, const glm::dvec3& point) {
    const WindowView window(View(*scene.camera, scene.width, scene.height));
    const glm::dvec2 up = window.to_window(window.see(point));
    return {up.x, scene.height - up.y};
}

TEST(ScaleBar, IsAsLongAsTwoPointsOfThePlaneThroughTheCenterAreApart) {
    for (const Camera& camera : cameras()) {
        const Scene scene = scene_of(camera);
        const Scale scale = scale_of(scene, 160);
        const View view(camera, scene.width, scene.height);
        for (const double angle : {0.0, 0.7, 2.0}) {
            const glm::dvec3 step =
                scale.length * (std::cos(angle) * view.right + std::sin(angle) * view.up);
            const double apart =
                glm::distance(seen(scene, camera.center), seen(scene, camera.center + step));
            // Coordinates of up to 5 in a view of 1e-6: 5 * 2^-52 / 1e-6 * 640 pixels is 1e-6.
            EXPECT_NEAR(apart, scale.pixels, 1e-5);
        }
        EXPECT_LE(scale.pixels, 160);
        EXPECT_GT(scale.pixels, 160 * 0.4);  // the next round length is at most 2.5 times as long
        EXPECT_EQ(round_number_up_to(scale.length), scale.length);
    }
}

TEST(ScaleBar, TakesAtMostAQuarterOfTheWidth) {
    const Scene scene = scene_of(cameras()[1]);
    const AnnotationStyle style(scene);
    Font font;
    Canvas canvas(scene.width, scene.height, {});
    Pen pen(style, font, &canvas);
    AnnotatedData data;
    data.length_unit = "mm";
    const Block block = scale_bar(pen, Annotation{}, scene, data);
    EXPECT_LE(block.size.x, 160);
    block.draw(pen, {100, 100});
    const auto layer = canvas.take();
    // The lowest row that is covered is that of the end marks: the bar's ends.
    int last = 0;
    for (int row = 0; row < scene.height; ++row)
        for (int column = 0; column < scene.width; ++column)
            if (layer->pixel(column, row)[3] > 0) last = row;
    double first_column = 1e9, last_column = 0;
    for (int column = 0; column < scene.width; ++column) {
        if (layer->pixel(column, last)[3] == 0) continue;
        first_column = std::min(first_column, double(column));
        last_column = column + 1;
    }
    EXPECT_NEAR(last_column - first_column, scale_of(scene, 160).pixels, 2);
}

TEST(Axes, PointAsTheWorldDoes) {
    const Scene scene = scene_of(cameras()[0]);
    const View view(*scene.camera, scene.width, scene.height);
    const AnnotationStyle style(scene);
    Font font;
    Canvas canvas(scene.width, scene.height, {});
    Pen pen(style, font, &canvas);
    axes_triad(pen, Annotation{}, scene, {}).draw(pen, {200, 200});
    const auto layer = canvas.take();
    // Centres of mass of what is red, green and blue lie along the axes from the common origin.
    glm::dvec2 mass[3] = {};
    double weight[3] = {};
    for (int row = 0; row < scene.height; ++row) {
        for (int column = 0; column < scene.width; ++column) {
            const float* const rgba = layer->pixel(column, row);
            for (int axis = 0; axis < 3; ++axis) {
                const float other = std::max(rgba[(axis + 1) % 3], rgba[(axis + 2) % 3]);
                const double excess = rgba[axis] - 1.3 * other;
                if (excess <= 0) continue;
                mass[axis] += excess * glm::dvec2(column, row);
                weight[axis] += excess;
            }
        }
    }
    const auto along = [&](int axis) { return glm::dvec2(view.right[axis], -view.up[axis]); };
    for (int axis = 0; axis < 3; ++axis) {
        ASSERT_GT(weight[axis], 0);
        mass[axis] /= weight[axis];
    }
    // The differences of the centres point as the differences of the axes do: each centre is near
    // the middle of its arrow.
    for (const auto& [a, b] : {std::pair(0, 1), {1, 2}, {2, 0}}) {
        const glm::dvec2 found = glm::normalize(mass[b] - mass[a]);
        const glm::dvec2 expected = glm::normalize(along(b) - along(a));
        EXPECT_GT(glm::dot(found, expected), 0.9) << a << ", " << b;
    }
}

using Room = std::function<bool(const std::vector<Rectangle>&)>;

std::shared_ptr<const Image> drawn_box(
    const Scene& scene, const AnnotatedData& data,
    const Room& make_room = [](const std::vector<Rectangle>&) { return true; }) {
    const AnnotationStyle style(scene);
    Font font;
    Canvas canvas(scene.width, scene.height, {});
    Pen pen(style, font, &canvas);
    draw_box(pen, Annotation{}, scene, data, make_room);
    return canvas.take();
}

TEST(Box, LinesLieOnTheEdgesOfTheData) {
    const Scene scene = scene_of(cameras()[0]);
    AnnotatedData data;
    data.corners = box_corners({-0.5, -0.4, -0.6}, {0.9, 0.7, 0.3});
    const auto layer = drawn_box(scene, data);
    int dim = 0;
    for (std::size_t from = 0; from < 8; ++from) {
        for (const std::size_t bit : {1, 2, 4}) {
            const glm::dvec2 a = seen(scene, data.corners[from]);
            const glm::dvec2 b = seen(scene, data.corners[from | bit]);
            if ((from & bit) != 0) continue;
            const glm::dvec2 middle = 0.37 * a + 0.63 * b;
            const float opacity = layer->pixel(int(middle.x), int(middle.y))[3];
            EXPECT_GT(opacity, 0.15) << from << " to " << (from | bit);
            dim += opacity < 0.5;
        }
    }
    EXPECT_GE(dim, 3);  // of a box seen from a corner, three edges are at the back
}

TEST(Box, DrawsNothingBehindTheEye) {
    Scene scene = scene_of(cameras()[0]);
    AnnotatedData data;
    data.corners = box_corners(glm::dvec3(20, -20, 20), glm::dvec3(30, -10, 30));
    const auto layer = drawn_box(scene, data);
    for (std::size_t i = 3; i < layer->rgba.size(); i += 4) ASSERT_EQ(layer->rgba[i], 0);
}

TEST(Box, LeavesNumbersOutOnlyWithAWord) {
    Scene scene = scene_of(cameras()[0]);
    AnnotatedData data;
    data.corners = box_corners({-0.5, -0.4, -0.6}, {0.9, 0.7, 0.3});
    const test::HeardWarnings heard;
    int asked = 0;
    drawn_box(scene, data, [&](const std::vector<Rectangle>& places) {
        EXPECT_GE(places.size(), 2u);
        return ++asked != 2;
    });
    EXPECT_EQ(asked, 3);
    EXPECT_NE(heard.all().find("box: no numbers along y:"), std::string::npos) << heard.all();
    drawn_box(scene, data);
    EXPECT_EQ(heard.all().find("along x"), std::string::npos);
    scene.width = 64;  // edges of a few pixels
    scene.height = 48;
    drawn_box(scene, data);
    EXPECT_NE(heard.all().find("no numbers along x, y, z"), std::string::npos) << heard.all();
}

}  // namespace
}  // namespace lamina
