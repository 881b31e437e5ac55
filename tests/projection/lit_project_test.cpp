// SPDX-License-Identifier: Apache-2.0
// Lit tets (docs/numerics.md, section 10) against a closed form and the lit tracer.
#include <glm/glm.hpp>

#include "projection_fixture.h"
#include "reference/lit_fixtures.h"
#include "scene/clip.h"
#include "simd/instruction_set.h"
#include "support/clips.h"
#include "support/delaunay_mesh.h"
#include "support/expect_error.h"
#include "support/split_box.h"

namespace lamina {
namespace {

using reference_test::directional;
using reference_test::lightings;
using reference_test::lit_by_one_gradient;

TransferFunction colors(double extinction) {
    return TransferFunction::linear(
        {knot(.1, {.9, .2, .1}, 0), knot(.4, {.3, .9, .2}, .4 * extinction),
         knot(.6, {1, .8, .7}, 3 * extinction), knot(1, {.1, .3, 1}, extinction)});
}

Scene lit_scene(double extinction, const Lighting& lighting, int width = 60, int height = 45) {
    Scene scene = projection_scene(colors(extinction), width, height);
    scene.camera->eye = {1.6, -.5, .9};
    scene.camera->center = {.5, .5, .5};
    scene.camera->up = {0, 1, .001};
    scene.camera->fov_y = 60;
    scene.camera->height = 1.6;
    scene.lighting = lighting;
    if ((*scene.lighting)->smallest_gradient.is_automatic())
        (*scene.lighting)->smallest_gradient = .05;
    return scene;
}

double linf(const Image& a, const Image& b) {
    return image_error(a, b).all.linf;
}

class LitProjection : public ProjectionTest {
  protected:
    void keeps_max_error(const SceneMesh& mesh, double extinction, const std::string& name) {
        for (const Lighting& lighting : lightings()) {
            for (const Projection projection :
                 {Projection::perspective, Projection::orthographic}) {
                Scene scene = lit_scene(extinction, lighting);
                scene.camera->projection = projection;
                const Image truth = trace(mesh, scene);
                for (const Coloring coloring : {Coloring::preintegrated, Coloring::analytic}) {
                    for (const double max_error : {1., 4.}) {
                        scene.project.coloring = coloring;
                        scene.max_error = max_error;
                        EXPECT_LE(linf(project(mesh, scene, capabilities()), truth), max_error)
                            << name << ", " << name_of(projection) << ", " << name_of(coloring)
                            << ", power " << lighting.power;
                    }
                }
            }
        }
    }
};

TEST_P(LitProjection, FineMeshesKeepMaxError) {
    keeps_max_error(scene_mesh(test::split_box(3, 1500, .05, waves)), 4, "split");
}

// In single tets, which may be opaque, light changes much.
TEST_P(LitProjection, CoarseMeshesKeepMaxError) {
    keeps_max_error(scene_mesh(test::kuhn_box({1, 1, 1}, waves)), 1, "kuhn");
    keeps_max_error(scene_mesh(test::kuhn_box({1, 1, 1}, waves)), 200, "opaque kuhn");
    keeps_max_error(scene_mesh(test::split_box(7, 40, .05, waves)), 10, "coarse");
}

TEST_P(LitProjection, KeepsMaxErrorWithTheEyeInside) {
    const SceneMesh mesh = scene_mesh(test::split_box(3, 300, .05, waves));
    Scene scene = lit_scene(3, directional());
    scene.camera->eye = {.31, .42, .63};
    EXPECT_LE(linf(project(mesh, scene, capabilities()), trace(mesh, scene)), scene.max_error);
}

// Gradients at the points are good to 1e-12, and where a ray meets a tet to float32: some 1e-5 of
// their length, as no sliver of this mesh is thinner than 1 / 100. Light multiplies this by less
// than 10; all other errors are sums of some hundred roundings.
TEST_P(LitProjection, ALinearFieldIsTheUnlitPictureTimesAConstant) {
    const glm::dvec3 gradient(.5, .25, -.125);
    const SceneMesh mesh = scene_mesh(test::split_box(
        5, 1000, .01, [&](const glm::dvec3& p) { return .2 + glm::dot(gradient, p); }));
    Scene scene = lit_scene(4, directional());
    scene.camera->projection = Projection::orthographic;
    Scene unlit = scene;
    unlit.lighting.reset();
    const Image lit = project(mesh, scene, capabilities()),
                plain = project(mesh, unlit, capabilities());
    const View view(*scene.camera, scene.width, scene.height);
    for (int row = 0; row < scene.height; ++row) {
        for (int column = 0; column < scene.width; ++column) {
            const float *const a = plain.pixel(column, row), *const b = lit.pixel(column, row);
            const glm::dvec3 expected = lit_by_one_gradient({a[0], a[1], a[2]}, a[3], gradient,
                                                            **scene.lighting, view.forward);
            ASSERT_NEAR(b[3], a[3], 1e-5);
            for (int c = 0; c < 3; ++c) ASSERT_NEAR(b[c], expected[c], 2e-4);
        }
    }
}

// The two pictures have the same formulas, but in OpenGL another program.
TEST_P(LitProjection, AmbientAloneIsTheUnlitPicture) {
    const SceneMesh mesh = scene_mesh(test::split_box(6, 500, .1, waves));
    for (const Coloring coloring : {Coloring::preintegrated, Coloring::analytic}) {
        Scene scene = lit_scene(4, reference_test::ambient_alone());
        scene.project.coloring = coloring;
        const Image lit = project(mesh, scene, capabilities());
        scene.lighting.reset();
        EXPECT_LE(linf(lit, project(mesh, scene, capabilities())), 255 * 1e-5);
    }
}

// The picture stays the same if everything is turned and scaled; the tracer's does, too
// (tests/reference/lit_mesh_test.cpp).
TEST_P(LitProjection, TurningAndScalingEverythingChangesNothing) {
    const glm::dmat3 turn({2. / 3, 1. / 3, 2. / 3}, {-2. / 3, 2. / 3, 1. / 3},
                          {-1. / 3, -2. / 3, 2. / 3});
    const double scale = 5;
    const MeshData data = test::split_box(6, 500, .1, waves);
    Scene scene = lit_scene(5, directional());
    const Image truth = trace(scene_mesh(data), scene);
    MeshData turned = data;
    for (glm::dvec3& point : turned.points) point = scale * (turn * point);
    scene.transfer_function = colors(5 / scale);
    for (Light& light : (*scene.lighting)->lights) light.direction = turn * *light.direction;
    (*scene.lighting)->smallest_gradient = *(*scene.lighting)->smallest_gradient / scale;
    scene.camera->eye = scale * (turn * scene.camera->eye);
    scene.camera->center = scale * (turn * scene.camera->center);
    scene.camera->up = turn * scene.camera->up;
    EXPECT_LE(linf(project(scene_mesh(turned), scene, capabilities()), truth), scene.max_error);
}

// New points on the plane have gradients from those of the uncut mesh, linear in its tets.
TEST_P(LitProjection, ClippedMeshesMeetTheTracer) {
    const auto mesh =
        std::make_shared<const SceneMesh>(scene_mesh(test::split_box(3, 300, .05, waves)));
    Scene scene = lit_scene(4, directional());
    for (const test::NamedClip& named : test::clips_of_unit_box()) {
        scene.clip = named.clip;
        const auto cut = clipped_mesh(mesh, scene.clip, true, "mesh");
        if (cut == nullptr) continue;
        EXPECT_LE(linf(project(*cut, scene, capabilities()), trace(*mesh, scene)), scene.max_error)
            << named.name;
    }
}

// A tet with a NaN shows nothing, and its neighbours are lit by the gradients of the other tets.
TEST_P(LitProjection, TetsWithNanLeaveTheirNeighborsLit) {
    MeshData data = test::split_box(6, 300, .1, waves);
    data.point_scalars[0].values[20] = NAN;
    const SceneMesh mesh = scene_mesh(data);
    Scene scene = lit_scene(4, directional());
    scene.nan = NanPolicy::transparent;
    EXPECT_LE(linf(project(mesh, scene, capabilities()), trace(mesh, scene)), scene.max_error);
}

// Roundings to codes add half a code a tet to the error of light.
TEST_P(LitProjection, OtherTargetsAreLit) {
    const SceneMesh mesh = scene_mesh(test::kuhn_box({3, 3, 3}, waves));
    Scene scene = lit_scene(.7, directional());
    (*scene.lighting)->diffuse = .4;
    (*scene.lighting)->specular = .2;  // no colour is clamped
    scene.camera->center = {1.5, 1.5, 1.5};
    scene.camera->eye = {6, -3, 4};
    const Image truth = trace(mesh, scene);
    for (const Target target : {Target::float16, Target::fixed16}) {
        scene.target = target;
        EXPECT_LE(linf(project(mesh, scene, capabilities()), truth), scene.max_error)
            << name_of(target);
    }
}

INSTANTIATE_TEST_SUITE_P(Engines, LitProjection, every_engine, engine_name);

TEST(LitTets, EveryInstructionSetGivesTheSameBits) {
    const SceneMesh mesh = scene_mesh(test::split_box(11, 500, 1e-2, waves));
    const std::vector<std::string> names = instruction_sets();
    for (const Lighting& lighting : lightings()) {
        for (const Coloring coloring : {Coloring::preintegrated, Coloring::analytic}) {
            Scene scene = lit_scene(4, lighting);
            scene.project.coloring = coloring;
            const Image best = project(mesh, scene, cpu_capabilities());
            for (const std::string& name : names) {
                restrict_instructions(name);
                EXPECT_EQ(project(mesh, scene, cpu_capabilities()).rgba, best.rgba) << name;
            }
            restrict_instructions(names.front());
        }
    }
}

// Nothing is divided by 0 if all tets are opaque from their faces on, or if gradients are nearly 0.
TEST(LitTets, StayFiniteAtExtremes) {
    const SceneMesh mesh = scene_mesh(test::kuhn_box(
        {2, 2, 2}, [](const glm::dvec3& p) { return p.x < 1.5 ? .5 : .5 + 1e-7 * p.y; }));
    for (const double extinction : {1e-30, 1., 1e30}) {
        for (const double smallest : {Lighting::least_gradient, 1., Lighting::largest_gradient}) {
            Lighting lighting = directional();
            lighting.smallest_gradient = smallest;
            const Image image = project(mesh, lit_scene(extinction, lighting), cpu_capabilities());
            for (const float value : image.rgba) ASSERT_TRUE(std::isfinite(value) && value >= 0);
        }
    }
}

TEST(LitTets, OmitNothingThatLightNeeds) {
    const SceneMesh mesh = scene_mesh(test::kuhn_box({2, 2, 2}, waves));
    Scene scene = projection_scene(TransferFunction::linear({knot(0, {1, .5, .2}, .5)}), 20, 15);
    scene.camera->eye = {9, -3, 4};
    const auto left_out = [&](const std::string& name) {
        const Plan plan = plan_of(mesh, scene, cpu_capabilities());
        return std::ranges::find(plan.omitted, name, &Omission::name) != plan.omitted.end();
    };
    for (const char* const name : {"color", "scalars", "order"}) EXPECT_TRUE(left_out(name));
    scene.lighting = lit_scene(1, Lighting{}).lighting;
    for (const char* const name : {"color", "scalars", "order"}) EXPECT_FALSE(left_out(name));
    const Plan plan = plan_of(mesh, scene, cpu_capabilities());
    EXPECT_EQ(plan.project.source, SegmentSource::parts);
    const std::string text = explain(plan, measure(scene, mesh), cpu_capabilities());
    EXPECT_NE(text.find("the gradient needs scalars and colour"), std::string::npos) << text;
}

TEST(LitTets, SettingsThatCannotBeLitAreRefused) {
    const SceneMesh mesh = scene_mesh(test::kuhn_box({2, 2, 2}, waves));
    const Scene lit = lit_scene(1, Lighting{});
    const auto refused = [&](const auto& change, std::initializer_list<std::string> words) {
        Scene scene = lit;
        change(scene);
        expect_error([&] { plan_of(mesh, scene, cpu_capabilities()); }, words);
    };
    for (const Coloring coloring : {Coloring::vertex, Coloring::attenuation}) {
        refused([&](Scene& scene) { scene.project.coloring = coloring; },
                {"render.project.coloring", name_of(coloring), "\"analytic\""});
    }
    refused([](Scene& scene) { scene.project.geometry = ProjectGeometry::triangles; },
            {"render.project", "triangles", "silhouettes"});
    refused([](Scene& scene) { scene.project.interpolation = Interpolation::linear; },
            {"render.project", "linear", "perspective"});
    refused([](Scene& scene) { scene.project.table = TableSettings{}; },
            {"render.project.table", "gradients"});
    refused([](Scene& scene) { scene.project.tree = TreeSettings{.factors = {4}}; },
            {"render.project.tree", "one colour"});
    refused([](Scene& scene) { (*scene.lighting)->smallest_gradient = automatic; },
            {"lighting.smallest_gradient"});
}

}  // namespace
}  // namespace lamina
