// SPDX-License-Identifier: Apache-2.0
// Tets thinner than double precision resolves, or of no volume: they show nothing.
#include <random>

#include "projection_fixture.h"

namespace lamina {
namespace {

// Returns tets between random points of the line x = y, z = 0, each moved off the line by about
// `width`.
SceneMesh needles(std::size_t tets, double width) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> along(0, 1);
    std::normal_distribution<double> aside(0, width > 0 ? width : 1);
    const auto off = [&] { return width > 0 ? aside(random) : 0; };
    MeshData data;
    data.point_scalars.push_back({"scalar", {}});
    for (std::size_t i = 0; i < 4 * tets; ++i) {
        const double t = along(random);
        data.points.push_back({t + off(), t + off(), off()});
        data.point_scalars[0].values.push_back(along(random));
    }
    for (std::int32_t i = 0; i < static_cast<std::int32_t>(4 * tets); i += 4)
        data.tets.push_back({i, i + 1, i + 2, i + 3});
    return scene_mesh(std::move(data));
}

class Needles : public ProjectionTest {};

// Draws few tets, and so many that depths on faces are float32 if possible. A ray meets a needle of
// width 1e-14 with a chance of some 1e-14 : 1 / 64.
TEST_P(Needles, ShowNothingIfTheyHaveNoWidth) {
    for (const std::size_t tets : {500u, 12000u}) {
        for (const double width : {0., 1e-16, 1e-14}) {
            const SceneMesh mesh = needles(tets, width);
            for (const auto projection : {Projection::perspective, Projection::orthographic}) {
                Scene scene = projection_scene(
                    TransferFunction::linear({knot(0, {1, 0, 0}, .5), knot(1, {0, 1, 1}, 5)}), 64,
                    64);
                scene.project.order = ProjectOrder::none;
                scene.camera->projection = projection;
                scene.camera->eye = {2, 1, 3};
                scene.camera->center = {.5, .5, 0};
                scene.camera->up = {0, 1, 0};
                scene.camera->fov_y = 30;
                scene.camera->height = 1.2;
                const Image drawn = project(mesh, scene, capabilities());
                const float most = *std::max_element(drawn.rgba.begin(), drawn.rgba.end());
                EXPECT_EQ(most, 0) << tets << " tets of width " << width;
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(, Needles, every_engine, engine_name);

}  // namespace
}  // namespace lamina
