// SPDX-License-Identifier: Apache-2.0
// Tests the plain tracer against closed forms: it must be right by itself before it can check the
// reference tracer.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/glm.hpp>
#include <numbers>

#include "plain/plain_scenes.h"
#include "plain/plain_tracer.h"
#include "reference/lit_fixtures.h"
#include "support/clips.h"
#include "support/split_box.h"
#include "support/volume_of.h"

namespace lamina {
namespace {

using namespace plain_test;

// Returns a camera that looks along z at all of the unit box, so that rays pass it from z = 0 to z
// = 1. No ray meets an edge of a tet.
Camera along_z() {
    Camera camera;
    camera.projection = Projection::orthographic;
    camera.eye = {.503, .507, -1};
    camera.center = {.503, .507, 0};
    camera.height = .9;
    return camera;
}

void expect_pixels(const PreciseImage& image, const glm::dvec4& expected, double tolerance) {
    for (int row = 0; row < image.height; ++row)
        for (int column = 0; column < image.width; ++column)
            for (int c = 0; c < 4; ++c)
                ASSERT_NEAR(image.pixel(column, row)[c], expected[c], tolerance)
                    << column << " " << row << " " << c;
}

// Draws a volume and a mesh whose scalar is z, in the unit box, and compares all pixels.
void expect_of_both(const TransferFunction& function, const glm::dvec4& expected) {
    const Scene scene = scene_of(function, along_z(), 11, 11);
    const auto z = [](const glm::dvec3& p) { return p.z; };
    const Volume volume = test::volume_of(unit_box, [](double, double, double k) { return k; });
    // Integrals have errors of 1e-7 of the opacity by their own estimate, and far less in fact: six
    // points of Gauss are off by 1e-12 where the depth is 1.
    expect_pixels(trace_plainly(scene, volume).image, expected, 1e-11);
    expect_pixels(trace_plainly(scene, mesh_of(test::split_box(3, 40, .1, z))).image, expected,
                  1e-11);
}

// Rounding: depths are sums of some 100 roundings below 1e-15.
TEST(PlainTracer, ConstantExtinctionHasTheOpacityOfTheChordThatTheClipKeeps) {
    const TransferFunction function = constant_function(1.5, {.25, 1, 3});
    Grid cells = make_grid({4, 3, 5}, Centering::cell, {.25, 1. / 3, .2});
    cells.origin = {.125, 1. / 6, .1};  // the unit box, too
    const Volume volume = test::volume_of(cells, [](double, double, double) { return 7; });
    const SceneMesh mesh = mesh_of(test::kuhn_box({1, 1, 1}, [](const auto&) { return 7; }));
    for (const Camera& camera : views_of(unit_box)) {
        Scene scene = scene_of(function, camera);
        for (const auto& [name, clip] : test::clips_of_unit_box()) {
            scene.clip = clip;
            const PreciseImage pictures[] = {trace_plainly(scene, volume).image,
                                             trace_plainly(scene, mesh).image};
            const View view(camera, scene.width, scene.height);
            for (int i = 0; i < scene.width * scene.height; ++i) {
                const int column = i % scene.width, row = i / scene.width;
                const double chord =
                    test::kept_length(clip, view.ray(column, row), {0, 0, 0}, {1, 1, 1});
                const double alpha = -std::expm1(-1.5 * chord);
                for (const PreciseImage& picture : pictures) {
                    ASSERT_NEAR(picture.pixel(column, row)[3], alpha, 1e-13) << name;
                    ASSERT_NEAR(picture.pixel(column, row)[2], 3 * alpha, 1e-11) << name;
                }
            }
        }
    }
}

// G (docs/numerics.md, section 5) is (1 - exp(-D)) / D if p = q.
TEST(PlainTracer, AColorThatIsLinearAlongTheRayHasItsClosedForm) {
    for (const double depth : {1e-6, .3, 5., 80., 1e6}) {
        const double t = std::exp(-depth), g = -std::expm1(-depth) / depth;
        const double front = 1 - g, back = g - t;
        expect_of_both(
            TransferFunction::linear({{0, {{1, 0, .5}, depth}}, {1, {{0, 2, .5}, depth}}}),
            {front, 2 * back, .5 * (1 - t), 1 - t});
    }
}

// G (docs/numerics.md, section 5) is an error function if p = 0.
TEST(PlainTracer, AnExtinctionThatIsLinearAlongTheRayHasItsClosedForm) {
    for (const double depth : {1e-3, .3, 5., 80.}) {
        const double root = std::sqrt(depth), t = std::exp(-depth);
        const double g = std::sqrt(std::numbers::pi) / 2 / root * std::erf(root);
        const double front = 1 - g, back = g - t;
        expect_of_both(
            TransferFunction::linear({{0, {{1, 0, .5}, 0}}, {1, {{0, 2, .5}, 2 * depth}}}),
            {front, 2 * back, .5 * (1 - t), 1 - t});
    }
}

// Two layers with a step between them, whose value some samples have. At the value itself the later
// knot counts.
TEST(PlainTracer, KnotsThatCoincideMakeLayers) {
    const double a = .7, b = 1.9, step = .5;
    expect_of_both(TransferFunction::linear({{step, {{1, 0, 0}, a}}, {step, {{0, 1, 0}, b}}}),
                   {-std::expm1(-a * step), std::exp(-a * step) * -std::expm1(-b * step), 0,
                    -std::expm1(-a * step - b * step)});
    const Volume flat = test::volume_of(unit_box, [&](double, double, double) { return step; });
    const Scene scene =
        scene_of(TransferFunction::linear({{step, {{1, 0, 0}, a}}, {step, {{0, 1, 0}, b}}}),
                 along_z(), 11, 11);
    expect_pixels(trace_plainly(scene, flat).image, {0, -std::expm1(-b), 0, -std::expm1(-b)},
                  1e-11);
}

// A linear field has one gradient, hence one factor (docs/numerics.md, section 10). Integrals of
// lit colours, up to 10 times the opacity, have errors of 1e-11.
TEST(PlainTracer, LitLinearFieldsAreTheUnlitPictureTimesAConstant) {
    const glm::dvec3 gradient(.5, .25, -.125);
    const auto field = [&](const glm::dvec3& p) { return .25 + glm::dot(gradient, p); };
    const Volume volume = test::volume_of<float>(unit_box, [&](double i, double j, double k) {
        return field({i, j, k});
    });
    const SceneMesh mesh = mesh_of(test::split_box(5, 100, .1, field));
    const Camera camera = camera_at(unit_box, Projection::orthographic, {1, .4, .7}, 1.2);
    Scene scene = scene_of(ramp_function(3), camera);
    const View view(camera, scene.width, scene.height);
    const auto expect_lit = [&](const auto& data, const Lighting& lighting) {
        scene.lighting.reset();
        const PreciseImage unlit = trace_plainly(scene, data).image;
        scene.lighting = lighting;
        const PreciseImage lit = trace_plainly(scene, data).image;
        for (std::size_t i = 0; i < unlit.rgba.size(); i += 4) {
            const double* const a = &unlit.rgba[i];
            const glm::dvec3 expected =
                lit_by_one_gradient({a[0], a[1], a[2]}, a[3], gradient, lighting, view.forward);
            ASSERT_EQ(lit.rgba[i + 3], a[3]);
            for (std::size_t c = 0; c < 3; ++c)
                ASSERT_NEAR(lit.rgba[i + c], expected[static_cast<int>(c)], 1e-10);
        }
    };
    for (Lighting lighting : lightings()) {
        lighting.smallest_gradient = .5;
        expect_lit(volume, lighting);
        expect_lit(mesh, lighting);
    }
}

// Depths that are not resolved count as errors: in this fog 60 halvings still leave depths of 1e12.
// The colour in the middle of the first part is right to 1e-12 nevertheless.
TEST(PlainTracer, EstimatesTheErrorThatHalvingLeaves) {
    const TransferFunction fog =
        TransferFunction::linear({{0, {{1, 0, .5}, 1e30}}, {1, {{0, 1, .5}, 1e30}}});
    const Volume volume = test::volume_of(unit_box, [](double, double, double k) { return k; });
    const PlainPicture picture = trace_plainly(scene_of(fog, along_z(), 11, 11), volume);
    EXPECT_GE(picture.error_estimate, .9);
    expect_pixels(picture.image, {1, 0, .5, 1}, 1e-12);
    const PlainPicture easy = trace_plainly(scene_of(ramp_function(3), along_z(), 11, 11), volume);
    EXPECT_LE(easy.error_estimate, 1e-7);
    EXPECT_GT(easy.error_estimate, 0);
}

}  // namespace
}  // namespace lamina
