// SPDX-License-Identifier: Apache-2.0
// Tets that hide one another in rings, and tets that overlap.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "lamina/settings.h"
#include "mesh_files/mesh_file.h"
#include "projection/projection_fixture.h"
#include "support/carved_mesh.h"
#include "support/needle_soup.h"
#include "support/overlapping_tets.h"

namespace lamina {
namespace {

class Rings : public ProjectionTest {
  protected:
    struct Drawn {
        Image picture;
        OrderReport order;
        ErrorFigure error;
    };
    Drawn draw(const SceneMesh& mesh, const Scene& scene) const {
        const Plan plan = plan_of(mesh, scene, capabilities());
        const auto renderer = make_project_renderer(mesh, *scene.transfer_function, plan.project,
                                                    capabilities(), scene.width, scene.height);
        renderer->draw(View(*scene.camera, scene.width, scene.height));
        return {renderer->read(), renderer->order_report(), plan.project.error};
    }
};

// Returns many colours, so that a wrong order shows.
TransferFunction colors() {
    return TransferFunction::linear({knot(0, {1, .1, 0}, 2), knot(.3, {0, 1, .2}, 9),
                                     knot(.7, {.1, 0, 1}, 4), knot(1, {1, 1, .3}, 12)});
}

MeshData valued(MeshData mesh) {
    MeshScalar scalar{"s", {}};
    for (std::size_t i = 0; i < mesh.points.size(); ++i)
        scalar.values.push_back(static_cast<double>(i * 7 % 11) / 10);
    mesh.point_scalars = {scalar};
    return mesh;
}

Scene scene_at(const glm::dvec3& eye, const glm::dvec3& center) {
    Scene scene = projection_scene(colors(), 120, 90);
    scene.camera->eye = eye;
    scene.camera->center = center;
    scene.camera->fov_y = 36;
    return scene;
}

struct RingScene {
    MeshData mesh;
    Scene scene;
};

std::vector<RingScene> ring_scenes() {
    std::vector<RingScene> scenes;
    scenes.push_back({valued(test::three_sticks({.3, .2, .25})), scene_at({.2, .1, 6}, {0, 0, 0})});
    scenes.push_back({valued(test::twisted_prism(20)), scene_at({.1, .03, 5}, {0, 0, 0})});
    for (const std::uint32_t seed : {1u, 2u, 3u}) {
        scenes.push_back(
            {test::needle_soup(150, seed, 1.1, .03), scene_at({.5, .4, 3}, {.5, .5, .5})});
    }
    return scenes;
}

// Error, in 1/255, that float32 may add (float_error in plan/project_planner.cpp).
constexpr double most = .05;

TEST_P(Rings, AreDrawnAsTheTracerSeesThem) {
    Lighting light;
    light.lights = {{.direction = glm::dvec3(.3, .5, 1)}};
    light.smallest_gradient = .1;
    for (const RingScene& each : ring_scenes()) {
        const SceneMesh mesh = scene_mesh(each.mesh);
        for (const bool lit : {false, true}) {
            for (const auto& order :
                 {Auto<ProjectOrder>(automatic), Auto<ProjectOrder>(ProjectOrder::exact)}) {
                Scene scene = each.scene;
                scene.project.order = order;
                if (lit) scene.lighting = light;
                const Drawn drawn = draw(mesh, scene);
                EXPECT_EQ(drawn.order.cycles > 0, GetParam() != Engine::opengl);  // walks: no order
                EXPECT_EQ(drawn.order.broken, 0);
                // Light is integrated to max_error.
                EXPECT_LE(image_error(drawn.picture, trace(mesh, scene)).all.linf,
                          lit ? scene.max_error : most);
            }
        }
    }
}

// Triangles are placed on a rasteriser's grid, so only means are compared: a picture in which rings
// are not solved is far worse.
TEST_P(Rings, AreDrawnByTrianglesToo) {
    for (const RingScene& each : ring_scenes()) {
        const SceneMesh mesh = scene_mesh(each.mesh);
        Scene scene = each.scene;
        scene.project.geometry = ProjectGeometry::triangles;
        const auto errors = image_error(draw(mesh, scene).picture, trace(mesh, scene));
        scene.project.order = ProjectOrder::centroid;
        const auto wrong = image_error(draw(mesh, scene).picture, trace(mesh, scene));
        EXPECT_LT(errors.all.l2, .5 * wrong.all.l2);
        EXPECT_LT(errors.all.l2, 1);
    }
}

TEST_P(Rings, AreTheSameInEveryTarget) {
    const RingScene each = ring_scenes().front();
    const SceneMesh mesh = scene_mesh(each.mesh);
    Scene scene = each.scene;
    scene.emulate.alpha = AlphaRounding::nearest;
    const Image exact = draw(mesh, scene).picture;
    for (const Target target :
         {Target::float16, Target::fixed16, Target::fixed8, Target::emulated}) {
        scene.target = target;
        // A pixel has three tets at most, and their parts are some ten fragments.
        EXPECT_LE(image_error(draw(mesh, scene).picture, exact).all.linf, 10);
    }
}

// Tets that overlap are composited by entry, by all methods.
TEST_P(Rings, AreDrawnAsTheTracerSeesThemIfTetsOverlap) {
    Lighting light;
    light.lights = {{.direction = glm::dvec3(.3, .5, 1)}};
    light.smallest_gradient = .1;
    for (const test::OverlapCase& each : test::overlap_cases()) {
        const SceneMesh mesh = scene_mesh(each.mesh);
        const bool has_lit_case = !each.name.ends_with("random ones");  // to save time
        // The second eye is inside of some meshes.
        for (const glm::dvec3& eye : {glm::dvec3(.3, .4, 2.4), glm::dvec3(.52, .45, .43)}) {
            for (const bool lit : {false, true}) {
                if (lit && !has_lit_case) continue;
                Scene scene = scene_at(eye, {.5, .5, .48});
                if (lit) scene.lighting = light;
                const Drawn drawn = draw(mesh, scene);
                EXPECT_EQ(drawn.order.broken, 0);
                EXPECT_EQ(drawn.error.kind, ErrorKind::sampled);
                EXPECT_LE(drawn.error.value, scene.max_error);
                EXPECT_LE(image_error(drawn.picture, trace(mesh, scene)).all.linf,
                          drawn.error.value)
                    << each.name;
            }
        }
    }
}

// A clip cuts a tet into several, which rays enter at places of their own.
TEST_P(Rings, HaveNoKnownErrorIfOverlappingTetsAreClipped) {
    const SceneMesh mesh = scene_mesh(test::tet_soup(8, 8));
    Scene scene = scene_at({.3, .4, 2.4}, {.5, .5, .5});
    scene.clip.planes = {{{.5, .5, .5}, {0, 0, 1}}};
    const ProjectPlan plan = plan_of(mesh, scene, capabilities()).project;
    EXPECT_EQ(plan.error.kind, ErrorKind::unknown);
    EXPECT_EQ(plan.overlaps, nullptr);
    EXPECT_FALSE(plan.solve_rings);  // dividing their pixels would take long, and err
}

// 450 tets in one cube, most of which overlap each other, are more than 50,000 pairs.
TEST_P(Rings, HaveNoKnownErrorIfTooManyPairsOverlap) {
    const SceneMesh mesh = scene_mesh(test::tet_soup(450, 3));
    Scene scene = scene_at({.3, .4, 2.4}, {.5, .5, .5});
    scene.width = 16;
    scene.height = 12;
    EXPECT_EQ(plan_of(mesh, scene, capabilities()).project.overlaps, nullptr);
    EXPECT_FALSE(plan_of(mesh, scene, capabilities()).project.solve_rings);
    const Drawn drawn = draw(mesh, scene);
    EXPECT_EQ(drawn.error.kind, ErrorKind::unknown);
    EXPECT_GT(drawn.order.broken, 0);
}

// An automatic order gives up on pictures that would take long; `exact` does not.
TEST_P(Rings, AreSolvedInPicturesOfFewPixelsUnlessTheOrderIsGiven) {
    const SceneMesh mesh = scene_mesh(test::tet_soup(60, 8));
    Scene scene = scene_at({.3, .4, 2.4}, {.5, .5, .5});
    const auto plan = [&] { return plan_of(mesh, scene, capabilities()).project; };
    EXPECT_TRUE(plan().solve_rings);
    scene.width = 4000;
    scene.height = 3000;
    EXPECT_FALSE(plan().solve_rings);
    EXPECT_EQ(plan().error.kind, ErrorKind::unknown);
    scene.project.order = ProjectOrder::exact;
    EXPECT_TRUE(plan().solve_rings);
    EXPECT_EQ(plan().error.kind, ErrorKind::sampled);
}

TEST_P(Rings, AreDrawnAsTheTracerSeesThemInTheCan) {
    const char* const folder = std::getenv("LAMINA_DATA");
    if (folder == nullptr) GTEST_SKIP() << "needs LAMINA_DATA";
    MeshData data = read_mesh(std::filesystem::path(folder) / "can.vtu");
    const double low = 2006.42, high = 5221.33;
    for (double& value : data.point_scalars.front().values) value = (value - low) / (high - low);
    const SceneMesh mesh = scene_mesh(std::move(data));
    Scene scene = scene_at({25, 20, 8}, {0, 0, -6});
    scene.width = 200;
    scene.height = 150;
    const Drawn drawn = draw(mesh, scene);
    EXPECT_GT(drawn.order.cycles, 0);
    EXPECT_EQ(drawn.order.broken, 0);
    EXPECT_EQ(drawn.error.kind, ErrorKind::sampled);
    EXPECT_LE(image_error(drawn.picture, trace(mesh, scene)).all.linf, drawn.error.value);
}

INSTANTIATE_TEST_SUITE_P(Engines, Rings, every_engine, engine_name);

}  // namespace
}  // namespace lamina
