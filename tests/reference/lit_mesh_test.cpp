// SPDX-License-Identifier: Apache-2.0
// Tests the invariants of docs/numerics.md, section 10, on lit meshes.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/glm.hpp>

#include "lit_fixtures.h"
#include "mesh/face_tree.h"
#include "reference/tracer.h"
#include "support/split_box.h"

namespace lamina {
namespace {

using namespace reference_test;

constexpr double mesh_tolerance = 1e-11;

TransferFunction peaks(double extinction) {
    return TransferFunction::linear({{0, {glm::dvec3(.1, .8, 0), 0}},
                                     {.3, {glm::dvec3(1, .2, .4), .1 * extinction}},
                                     {.6, {glm::dvec3(0, 0, 1), extinction}},
                                     {1, {glm::dvec3(.3, 1, .2), .5 * extinction}}});
}

double waves(const glm::dvec3& p) {
    return .5 + .5 * std::sin(5 * p.x + 3 * p.y * p.z);
}

TraceResult trace(const MeshData& data, const TransferFunction& function, const View& view,
                  const TraceOptions& options) {
    const TetMesh mesh(data, "test");
    const FaceTree tree(mesh, mesh.open_faces());
    return trace_mesh(mesh, tree, mesh.point_scalars()[0].values, function, view, options);
}

View view_of_box(Projection projection) {
    return View(camera_at(unit_box, projection, {1, .4, .7}, 1.2), 25, 20);
}

// Gradients at the points have an error of 1e-12 in this mesh (slivers do not count much, because
// means are weighted by volume). Light changes by less than 10 times that.
TEST(LitMesh, ALinearFieldIsTheUnlitPictureTimesAConstant) {
    const glm::dvec3 gradient(.5, .25, -.125);
    const MeshData data = test::split_box(
        5, 3000, .01, [&](const glm::dvec3& p) { return .2 + glm::dot(gradient, p); });
    const View view = view_of_box(Projection::orthographic);
    const PreciseImage unlit = trace(data, peaks(6), view, {mesh_tolerance, {}}).image;
    const PreciseImage lit = trace(data, peaks(6), view, {mesh_tolerance, directional()}).image;
    EXPECT_GT(largest_alpha(lit), .5);
    for (int row = 0; row < view.height; ++row) {
        for (int column = 0; column < view.width; ++column) {
            const double* const a = unlit.pixel(column, row);
            const double* const b = lit.pixel(column, row);
            const glm::dvec3 expected = lit_by_one_gradient({a[0], a[1], a[2]}, a[3], gradient,
                                                            directional(), view.forward);
            ASSERT_EQ(b[3], a[3]);
            for (int c = 0; c < 3; ++c) ASSERT_NEAR(b[c], expected[c], 2 * mesh_tolerance + 1e-11);
        }
    }
}

TEST(LitMesh, AmbientAloneAndNoWeightAreTheUnlitPicture) {
    const MeshData data = test::split_box(6, 500, .1, waves);
    Lighting no_weight = directional();
    no_weight.smallest_gradient = Lighting::largest_gradient;
    for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
        const View view = view_of_box(projection);
        const TraceResult unlit = trace(data, peaks(4), view, {});
        const TraceResult ambient = trace(data, peaks(4), view, {1e-5, ambient_alone()});
        // Lit segments are summed one by one, others in vectors that share a Gauss rule. Either has
        // an error of some 1e-15 of the opacity (optics/segment_integral.h).
        const TraceResult weightless = trace(data, peaks(4), view, {1e-5, no_weight});
        EXPECT_LE(largest_difference(ambient.image, unlit.image), 1e-14);
        EXPECT_LE(largest_difference(weightless.image, unlit.image), 1e-14);
        EXPECT_GT(largest_difference(trace(data, peaks(4), view, {1e-5, directional()}).image,
                                     unlit.image),
                  .1);
    }
}

// A turned and scaled scene, as in lit_volume_test.cpp. Rounding displaces rays by some 1e-15, and
// the tets of this mesh are not thin.
TEST(LitMesh, TurningAndScalingEverythingChangesNothing) {
    const glm::dmat3 turn({2. / 3, 1. / 3, 2. / 3}, {-2. / 3, 2. / 3, 1. / 3},
                          {-1. / 3, -2. / 3, 2. / 3});
    const double scale = 5;
    const MeshData data = test::split_box(6, 500, .1, waves);
    MeshData turned = data;
    for (glm::dvec3& point : turned.points) point = scale * (turn * point);
    Lighting lighting = directional();
    for (Light& light : lighting.lights) light.direction = turn * *light.direction;
    lighting.smallest_gradient = *lighting.smallest_gradient / scale;
    for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
        const Camera camera = camera_at(unit_box, projection, {1, .4, .7}, 1.2);
        Camera other = camera;
        other.eye = scale * (turn * camera.eye);
        other.center = scale * (turn * camera.center);
        other.up = turn * camera.up;
        other.height *= scale;
        const auto picture = [](const MeshData& mesh, double extinction, const Camera& from,
                                const Lighting& by) {
            return trace(mesh, peaks(extinction), View(from, 25, 20), {mesh_tolerance, by}).image;
        };
        EXPECT_LE(largest_difference(picture(data, 5, camera, directional()),
                                     picture(turned, 5 / scale, other, lighting)),
                  2 * mesh_tolerance + 1e-11);
    }
}

// A tet with a NaN shows nothing, and the points around it get the gradients of their other tets.
TEST(LitMesh, TetsWithNanLeaveTheirNeighborsLit) {
    MeshData data = test::split_box(6, 300, .1, waves);
    data.point_scalars[0].values[20] = NAN;
    const View view = view_of_box(Projection::perspective);
    const TraceResult unlit = trace(data, peaks(4), view, {});
    const TraceResult lit = trace(data, peaks(4), view, {1e-6, directional()});
    EXPECT_GT(largest_difference(lit.image, unlit.image), .1);
    for (std::size_t i = 0; i < lit.image.rgba.size(); ++i) {
        ASSERT_TRUE(std::isfinite(lit.image.rgba[i]));
        if (i % 4 == 3) {
            ASSERT_EQ(lit.image.rgba[i], unlit.image.rgba[i]);
        }
    }
}

TEST(LitMesh, TheErrorEstimateCoversTheError) {
    Random random(44);
    for (int i = 0; i < 20; ++i) {
        const MeshData data = test::split_box(static_cast<std::uint32_t>(i), 60, .1, waves);
        const TransferFunction function = peaks(random.uniform(.1, 30));
        const Lighting lighting = random_lighting(random);
        const View view(
            camera_at(unit_box, i % 3 ? Projection::perspective : Projection::orthographic,
                      random.point(-1, 1), random.uniform(.3, 1)),
            12, 10);
        const TraceResult exact = trace(data, function, view, {1e-11, lighting});
        for (const double each : {1e-2, 1e-4, 1e-5, 1e-6, 1e-8}) {
            const TraceResult result = trace(data, function, view, {each, lighting});
            EXPECT_LE(result.error_estimate, each);
            EXPECT_LE(largest_difference(result.image, exact.image),
                      result.error_estimate + exact.error_estimate)
                << i << " " << each;
        }
    }
}

}  // namespace
}  // namespace lamina
