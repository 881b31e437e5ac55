// SPDX-License-Identifier: Apache-2.0
#include "reference/tracer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/glm.hpp>

#include "fixtures.h"
#include "support/split_box.h"

namespace lamina {
namespace {

using reference_test::make_grid;
using reference_test::make_volume;

constexpr int length = 4;  // of the box, along x

// Returns a box with the value x. Eight samples would do, but with more of them rays cross several
// cells.
Volume ramp_volume() {
    const Grid grid = make_grid({length + 1, 3, 3}, Centering::node);
    std::vector<float> samples;
    for (int i = 0; i < 3 * 3; ++i)
        for (int x = 0; x <= length; ++x) samples.push_back(static_cast<float>(x));
    return make_volume(grid, samples);
}

const std::array<std::int32_t, 3> ramp_cells{length, 2, 2};

// Returns a scene that looks along x from outside, with the middle of the box in the middle of the
// picture.
Scene scene_along_x(Projection projection, const TransferFunction& transfer) {
    Scene scene;
    scene.transfer_function = transfer;
    scene.camera->projection = projection;
    scene.camera->eye = {-3, 1.1, .9};
    scene.camera->center = {1, 1.1, .9};
    scene.width = scene.height = 3;
    scene.camera->height = .01;
    scene.camera->fov_y = .01;
    return scene;
}

// Points seen in a volume and in a mesh, whose value is x.
struct Rays {
    std::optional<SeenPoint> of_volume, of_mesh;
};
Rays seen(const Scene& scene, double column = 1, double row = 1) {
    const MeshData data = test::kuhn_box(ramp_cells, [](const glm::dvec3& p) { return p.x; });
    const SceneMesh mesh = scene_mesh(scene, data);
    const FaceTree open_faces(mesh.mesh, mesh.mesh.open_faces());
    return {seen_point(scene, ramp_volume(), column, row),
            seen_point(scene, mesh, open_faces, column, row)};
}

double depth_of_half_opacity(double depth) {
    return -std::log((1 + std::exp(-depth)) / 2);
}

// Expects a point at x. Ends of segments have errors of some 16 epsilons of the distance
// (mesh/ray_walk.cpp), 4e-15 here. The place is off by the depth's error divided by the extinction,
// at least .05, so 1e-12 is generous. Depths stay below 18, where a ray ends because the rest is
// hidden.
void expect_at(const std::optional<SeenPoint>& point, double x, double opacity) {
    ASSERT_TRUE(point);
    EXPECT_NEAR(point->position.x, x, 1e-12);
    EXPECT_NEAR(point->position.y, 1.1, 1e-12);
    EXPECT_NEAR(point->position.z, .9, 1e-12);
    EXPECT_NEAR(point->value, x, 1e-12);
    EXPECT_NEAR(point->opacity, opacity, 1e-12);
}

TEST(SeenPoint, MatchesTheClosedFormOfOneExtinction) {
    for (const Projection projection : {Projection::orthographic, Projection::perspective}) {
        for (const double extinction : {.05, 1.0, 4.0}) {
            const Rays rays = seen(scene_along_x(
                projection, TransferFunction::linear({{0, {glm::dvec3(1), extinction}}})));
            const double depth = extinction * length;
            const double x = depth_of_half_opacity(depth) / extinction;
            for (const auto& point : {rays.of_volume, rays.of_mesh})
                expect_at(point, x, -std::expm1(-depth));
        }
    }
}

// With extinction k x the depth up to x is k x^2 / 2. A clip at x = 1 takes away k / 2 of it.
TEST(SeenPoint, MatchesTheClosedFormOfARamp) {
    for (const bool clipped : {false, true}) {
        for (const double k : {.1, 2.0}) {
            Scene scene =
                scene_along_x(Projection::perspective,
                              TransferFunction::linear({{0, {glm::dvec3(1), 0}},
                                                        {length, {glm::dvec3(1), length * k}}}));
            if (clipped) scene.clip.planes = {{{1, 0, 0}, {1, 0, 0}}};
            const double before = clipped ? k / 2 : 0, depth = k * length * length / 2 - before;
            const double x = std::sqrt(2 * (before + depth_of_half_opacity(depth)) / k);
            const Rays rays = seen(scene);
            for (const auto& point : {rays.of_volume, rays.of_mesh})
                expect_at(point, x, -std::expm1(-depth));
        }
    }
}

TEST(SeenPoint, IsNoneWhereNothingIsSeen) {
    const Scene opaque =
        scene_along_x(Projection::perspective, TransferFunction::linear({{0, {glm::dvec3(1), 1}}}));
    const Rays beside = seen(opaque, 1e6, 1);  // misses the box
    EXPECT_FALSE(beside.of_volume || beside.of_mesh);
    const Rays clear = seen(scene_along_x(Projection::perspective,
                                          TransferFunction::linear({{0, {glm::dvec3(1), 0}}})));
    EXPECT_FALSE(clear.of_volume || clear.of_mesh);
}

}  // namespace
}  // namespace lamina
