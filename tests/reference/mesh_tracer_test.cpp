// SPDX-License-Identifier: Apache-2.0
#include "reference/tracer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/glm.hpp>

#include "fixtures.h"
#include "optics/segment_integral.h"
#include "reference/chord.h"
#include "support/split_box.h"

namespace lamina {
namespace {

using reference_test::camera_at;
using reference_test::make_grid;

TransferFunction constant_extinction(double extinction) {
    return TransferFunction::linear({{0, {glm::dvec3(.2, .5, 1), extinction}}});
}

TransferFunction ramp(double extinction) {
    return TransferFunction::linear({{0, {glm::dvec3(.1, .8, 0), 0}},
                                     {.3, {glm::dvec3(1, .2, .4), .1 * extinction}},
                                     {.6, {glm::dvec3(0, 0, 1), extinction}},
                                     {1, {glm::dvec3(.3, 1, .2), .5 * extinction}}});
}

TraceResult trace(const MeshData& data, const TransferFunction& transfer, const View& view) {
    const TetMesh mesh(data, "test");
    const FaceTree tree(mesh, mesh.open_faces());
    return trace_mesh(mesh, tree, mesh.point_scalars()[0].values, transfer, view);
}

// With one extinction, alpha is 1 - exp(-extinction * chord), also through needles. The two ends of
// the chord have errors of some epsilon of the distance (up to 6), and errors between them cancel.
// The allowed 1e-12 * extinction in depth is 100 times that.
TEST(MeshTracer, HomogeneousMeshesEqualTheClosedForm) {
    for (const double least : {.1, 1e-3, 1e-6}) {
        const MeshData data =
            test::split_box(3, 4000, least, [](const glm::dvec3&) { return 0.25; });
        for (const double extinction : {1e-6, 1.0, 30.0}) {
            for (const Projection projection :
                 {Projection::perspective, Projection::orthographic}) {
                for (const double distance : {0.0, .2, 2.0}) {
                    const View view(camera_at(unit_box, projection, {.5, .3, 1}, distance + 1e-3),
                                    24, 20);
                    const TraceResult result = trace(data, constant_extinction(extinction), view);
                    for (int y = 0; y < view.height; ++y)
                        for (int x = 0; x < view.width; ++x) {
                            const double chord = chord_length(unit_box, view, x, y);
                            const double alpha = -std::expm1(-extinction * chord);
                            ASSERT_NEAR(result.image.pixel(x, y)[3], alpha,
                                        1e-12 * std::min(1.0, extinction));
                            ASSERT_NEAR(result.image.pixel(x, y)[1], .5 * alpha,
                                        1e-12 * std::min(1.0, extinction));
                        }
                    EXPECT_EQ(result.overlapping_rays, 0);
                }
            }
        }
    }
}

// In a field that is linear over all of the mesh, the ray is one segment in closed form. Values at
// crossings have errors of some 1e-13; extinction changes by at most 20 per unit of the scalar.
TEST(MeshTracer, LinearFieldsEqualOneSegment) {
    const glm::dvec3 gradient(.5, .3, .2);
    const auto field = [&](const glm::dvec3& p) { return glm::dot(gradient, p); };
    for (const double least : {.1, 1e-6}) {
        const MeshData data = test::split_box(5, 4000, least, field);
        const View view(camera_at(unit_box, Projection::perspective, {1, .4, .7}, 1.5), 30, 30);
        const TransferFunction transfer = ramp(6);
        const TraceResult result = trace(data, transfer, view);
        int hits = 0;
        for (int y = 0; y < view.height; ++y)
            for (int x = 0; x < view.width; ++x) {
                const View::Ray ray = view.ray(x, y);
                const Chord chord = clip_to_box(unit_box, ray);
                const double* const pixel = result.image.pixel(x, y);
                if (!(chord.length_z > 1e-9)) continue;
                ++hits;
                const SegmentIntegral expected = integrate_segment(
                    transfer, field(chord.entry),
                    field(chord.entry + chord.length_z * chord.direction), chord.world_length());
                for (int c = 0; c < 3; ++c)
                    ASSERT_NEAR(pixel[c], expected.color[c], result.error_estimate);
                ASSERT_NEAR(pixel[3], expected.alpha, result.error_estimate);
            }
        EXPECT_GT(hits, 100);
        EXPECT_LT(result.error_estimate, 1e-10);
    }
}

// The six tets of a box must give the same as one segment: to 1e-12 relative, in every channel, for
// optical depths from 1e-8 to 1e6.
TEST(MeshTracer, StiffBoxesEqualOneSegment) {
    const MeshData data = test::kuhn_box({1, 1, 1}, [](const glm::dvec3& p) { return p.z; });
    Camera camera;
    camera.projection = Projection::orthographic;
    camera.center = {.5, .5, .5};
    camera.eye = {.5, .5, 3};
    camera.height = 1;
    const View view(camera, 5, 5);
    for (const double depth : {1e-8, 1e-3, 1.0, 40.0, 1e3, 1e6}) {
        const TraceResult result = trace(data, ramp(depth), view);
        const SegmentIntegral expected = integrate_segment(ramp(depth), 1, 0, 1);
        for (int y = 0; y < 5; ++y)
            for (int x = 0; x < 5; ++x) {
                const double* const pixel = result.image.pixel(x, y);
                for (int c = 0; c < 3; ++c)
                    EXPECT_NEAR(pixel[c], expected.color[c], 1e-12 * expected.color[c]) << depth;
                EXPECT_NEAR(pixel[3], expected.alpha, 1e-12 * expected.alpha);
            }
    }
}

// Pixel centres lie exactly over the mesh's edges and points, and nothing leaks. Along x the box is
// 4 long.
TEST(MeshTracer, NothingLeaksThroughEdgesAndPoints) {
    const MeshData data = test::kuhn_box({4, 4, 4}, [](const glm::dvec3&) { return 0; });
    Camera camera;
    camera.projection = Projection::orthographic;
    camera.center = {2, 2, 2};
    camera.eye = {9, 2, 2};
    camera.height = 16 * .25;
    const View view(camera, 17, 16);  // centres at multiples of a quarter across, between up
    const TraceResult result = trace(data, constant_extinction(.5), view);
    int inside = 0;
    for (int y = 0; y < view.height; ++y)
        for (int x = 0; x < view.width; ++x) {
            const glm::dvec3 place = view.ray(x, y).origin;
            if (place.z <= 0 || place.z >= 4) continue;
            ++inside;
            EXPECT_NEAR(result.image.pixel(x, y)[3], -std::expm1(-2.0), 1e-15);
        }
    EXPECT_EQ(inside, 15 * 16);
}

// On these rays the scalar is constant, exactly where the transfer function steps from nothing to
// opaque. Rounding decides what a tet shows, and the estimate must include that.
TEST(MeshTracer, EstimateIncludesTheSidesOfSteps) {
    const glm::dvec3 gradient(.3, .7, 0);  // the rays below run along z
    const MeshData data =
        test::split_box(9, 2000, 1e-3, [&](const glm::dvec3& p) { return glm::dot(gradient, p); });
    Camera camera;
    camera.projection = Projection::orthographic;
    camera.center = {.4, .35, 0};
    camera.eye = {.4, .35, 5};
    camera.height = .25;
    const View view(camera, 1, 1);
    const double value = glm::dot(gradient, camera.eye);
    const TransferFunction step =
        TransferFunction::linear({{value, {glm::dvec3(1), 0}}, {value, {glm::dvec3(1), 3}}});
    const TraceResult result = trace(data, step, view);
    const double shown = result.image.pixel(0, 0)[3];  // of at most 1 - exp(-3)
    EXPECT_GE(result.error_estimate, std::max(shown, -std::expm1(-3.0) - shown) - 1e-12);
    EXPECT_LT(trace(data, constant_extinction(3), view).error_estimate, 1e-10);
}

TEST(MeshTracer, TetsWithoutValueAreTransparent) {
    MeshData data = test::kuhn_box({1, 1, 2}, [](const glm::dvec3&) { return 0; });
    for (std::size_t i = 8; i < 12; ++i) data.point_scalars[0].values[i] = NAN;  // the plane z = 2
    Camera camera;
    camera.projection = Projection::orthographic;
    camera.center = {.5, .5, 0};
    camera.eye = {.5, .5, 5};
    const View view(camera, 3, 3);
    const TraceResult result = trace(data, constant_extinction(1), view);
    EXPECT_NEAR(result.image.pixel(0, 1)[3], -std::expm1(-1.0), 1e-15);
}

// If a box lies twice in the mesh, its extinction counts twice.
TEST(MeshTracer, OverlapsAreCounted) {
    MeshData data = test::kuhn_box({1, 1, 1}, [](const glm::dvec3&) { return 0; });
    const MeshData again = data;
    for (const glm::dvec3& p : again.points) data.points.push_back(p + glm::dvec3(0, 0, .25));
    for (const Tet& t : again.tets) data.tets.push_back({t[0] + 8, t[1] + 8, t[2] + 8, t[3] + 8});
    data.point_scalars[0].values.resize(16, 0);
    Camera camera;
    camera.projection = Projection::orthographic;
    camera.center = {.5, .5, 0};
    camera.eye = {.5, .5, 5};
    const View view(camera, 2, 2);
    const TraceResult result = trace(data, constant_extinction(1), view);
    EXPECT_EQ(result.overlapping_rays, 4);
    EXPECT_NEAR(result.image.pixel(0, 0)[3], -std::expm1(-2.0), 1e-14);
}

}  // namespace
}  // namespace lamina
