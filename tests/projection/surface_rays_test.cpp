// SPDX-License-Identifier: Apache-2.0
// Rays that run along a surface of a mesh, at which what a ray shows jumps: a rounding decides on
// which side of it a whole ray is, so that pictures claim no error, or one that counts it.
#include "facts/surface_rays.h"

#include <gmock/gmock.h>

#include <cmath>
#include <memory>

#include "projection_fixture.h"
#include "scene/clip.h"
#include "support/carved_mesh.h"
#include "support/split_box.h"

namespace lamina {
namespace {

const double diagonal = std::sqrt(12);  // of the box

// A box of 2 x 2 x 2 cubes whose scalar is x.
SceneMesh ramp_box() {
    return scene_mesh(test::kuhn_box({2, 2, 2}, [](const glm::dvec3& p) { return p.x; }));
}

// Parallel rays along z, whose middle column lies at x. Pixels are .4 wide.
Scene along_z(double x, const TransferFunction& transfer_function) {
    Scene scene = projection_scene(transfer_function, 7, 7);
    scene.camera->projection = Projection::orthographic;
    scene.camera->height = 2.8;
    scene.camera->eye = {x, 1.03, 5};
    scene.camera->center = {x, 1.03, 0};
    scene.camera->up = {0, 1, 0};
    return scene;
}

// An eye at the given x sees the rows of along_z() in perspective.
Scene from_eye(double x, const TransferFunction& transfer_function) {
    Scene scene = along_z(x, transfer_function);
    scene.camera->projection = Projection::perspective;
    scene.camera->fov_y = 40;
    return scene;
}

double surface_error(const SceneMesh& mesh, const Scene& scene) {
    return measure(scene, mesh).surface_error;
}

TransferFunction jump(double value, double before, double after) {
    return TransferFunction::linear(
        {knot(value, {1, 1, 1}, before), knot(value, {1, 1, 1}, after)});
}

const TransferFunction without_jumps =
    TransferFunction::linear({knot(0, {1, 1, 1}, .2), knot(2, {1, 1, 1}, .7)});

TEST(SurfaceRays, InTheBoundaryMayShowAllOrNothing) {
    // A tet at x = 2 has scalars from 1 to 2, so that the extinction is .7 at most.
    EXPECT_DOUBLE_EQ(surface_error(ramp_box(), along_z(2, without_jumps)),
                     -std::expm1(-.7 * diagonal));
    EXPECT_GT(surface_error(ramp_box(), along_z(0, without_jumps)), 0);
    EXPECT_GT(surface_error(ramp_box(), along_z(2.4, without_jumps)),
              0);  // in the column beside the middle
    EXPECT_GT(surface_error(ramp_box(), along_z(2 + 1e-8, without_jumps)), 0);
    EXPECT_GT(surface_error(ramp_box(), from_eye(2, without_jumps)), 0);
    EXPECT_EQ(surface_error(ramp_box(), along_z(2.1, without_jumps)), 0);
    EXPECT_EQ(surface_error(ramp_box(), from_eye(2.1, without_jumps)), 0);
    // Nothing shows on either side of the boundary at x = 0.
    EXPECT_EQ(surface_error(ramp_box(), along_z(0, jump(1.5, 0, 3))), 0);
}

TEST(SurfaceRays, OutsideOfThePictureOrBehindTheEyeDoNotCount) {
    Scene scene = along_z(2, without_jumps);
    scene.camera->eye.z = -.1;
    scene.camera->center.z = -5;
    EXPECT_EQ(surface_error(ramp_box(), scene), 0);
    scene = from_eye(2, without_jumps);
    scene.camera->eye.z = scene.camera->center.z = 1;
    scene.camera->center.x = 7;  // the eye is in the face x = 2 and looks away from the mesh
    EXPECT_EQ(surface_error(ramp_box(), scene), 0);
    scene.camera->center = {-7, 1.03, 1};
    EXPECT_EQ(surface_error(ramp_box(), scene), 0);  // and into it: the face is behind the picture
    scene = along_z(2, without_jumps);
    scene.camera->eye.y = scene.camera->center.y = 9;
    EXPECT_EQ(surface_error(ramp_box(), scene), 0);
}

TEST(SurfaceRays, AtAJumpMayShowItsOtherSide) {
    for (const double level : {.3, 1., 1.7}) {
        const TransferFunction transfer_function = jump(level, .1, .6);
        EXPECT_DOUBLE_EQ(surface_error(ramp_box(), along_z(level, transfer_function)),
                         -std::expm1(-.5 * diagonal))
            << level;
        EXPECT_GT(surface_error(ramp_box(), from_eye(level, transfer_function)), 0) << level;
        EXPECT_EQ(surface_error(ramp_box(), along_z(level + .01, transfer_function)), 0) << level;
        EXPECT_EQ(surface_error(ramp_box(), from_eye(level + .01, transfer_function)), 0) << level;
    }
    // Rays along x cross the surface.
    Scene across = along_z(.3, jump(.3, .1, .6));
    across.camera->eye = {9, 1.03, 1.04};
    across.camera->center = {0, 1.03, 1.04};
    EXPECT_EQ(surface_error(ramp_box(), across), 0);
}

// A jump of colour counts by the light that has it: t l with t the extinction.
TEST(SurfaceRays, CountJumpsOfColor) {
    const auto at = [](double extinction) {
        return TransferFunction::linear(
            {knot(.3, {1, 0, 0}, extinction), knot(.3, {0, .5, 0}, extinction)});
    };
    EXPECT_DOUBLE_EQ(surface_error(ramp_box(), along_z(.3, at(.01))), .01 * diagonal);
    EXPECT_DOUBLE_EQ(surface_error(ramp_box(), along_z(.3, at(9))), 1);
}

// Along a steep ramp a rounding of 2^-22 of the window moves the scalar by a share of the ramp.
TEST(SurfaceRays, AlongSteepRampsMayShowSomeOfTheirOtherSide) {
    const auto ramp = [](double width) {
        return TransferFunction::linear({knot(0, {1, 1, 1}, .1), knot(.3, {1, 1, 1}, .1),
                                         knot(.3 + width, {1, 1, 1}, 50), knot(2, {1, 1, 1}, 51)});
    };
    // The window reaches from a margin of 1/16 of 1.7 below .3 to 2.
    const double rounding = 0x1p-22 * (1.7 + 1.7 / 16);
    EXPECT_NEAR(surface_error(ramp_box(), along_z(.3001, ramp(2e-4))),
                -std::expm1(-49.9 * rounding / 2e-4 * diagonal), 1e-6);
    EXPECT_EQ(surface_error(ramp_box(), along_z(.31, ramp(2e-4))), 0);
    EXPECT_EQ(surface_error(ramp_box(), along_z(.305, ramp(.01))), 0);
}

// Values of one tet that are all equal round alike.
TEST(SurfaceRays, OfConstantTetsAreOnOneSide) {
    SceneMesh mesh = ramp_box();
    for (double& value : mesh.scalar.values) value = value > 1.5 ? 1.5 : .3;
    const Scene scene =
        along_z(.55, TransferFunction::linear({knot(.3, {1, 1, 1}, .1), knot(.3, {1, 1, 1}, .6),
                                               knot(2, {1, 1, 1}, .7)}));
    EXPECT_EQ(surface_error(mesh, scene), 0);
    mesh.scalar.values.front() += 1e-9;  // this tet is not constant, but roundings may pass .3
    EXPECT_GT(surface_error(mesh, scene), 0);
}

// In a window much wider than a tet's range, roundings move its surface by far more than those of
// places: here by 2^-22 * 2.1 / 1e-4 = .005, .125 pixels. The rays are askew to it by .003 of the
// length of its parts in tets, which is .3 to 1: by .02 to .075 pixels.
TEST(SurfaceRays, AreFoundIfRoundingsOfAWideWindowMoveTheSurface) {
    SceneMesh mesh = ramp_box();
    for (double& value : mesh.scalar.values) value = 1 + 1e-4 * value;
    mesh.scalar.values.front() = 0;
    mesh.scalar.values.back() = 2;
    Scene scene = along_z(
        1.3, TransferFunction::linear({knot(0, {1, 1, 1}, .1), knot(1.00013, {1, 1, 1}, .2),
                                       knot(1.00013, {1, 1, 1}, .6), knot(2, {1, 1, 1}, .9)}));
    scene.camera->height = .28;
    scene.camera->eye.x += .015;
    const double across = -std::expm1(-.4 * diagonal);
    EXPECT_NEAR(surface_error(mesh, scene), across, 1e-9);
    // Half a pixel is too far, and so is an angle of .1.
    scene.camera->eye.x += .02;
    scene.camera->center.x += .02;
    EXPECT_EQ(surface_error(mesh, scene), 0);
    scene.camera->eye.x += .5;
    scene.camera->center.x -= .02;
    EXPECT_EQ(surface_error(mesh, scene), 0);
}

// Views look only at tets that data and transfer function leave: here those of one side of the box,
// and those beside tets without a value.
TEST(SurfaceRays, AreLookedForInTetsWithAJump) {
    SceneMesh mesh = ramp_box();
    EXPECT_EQ(measure_data(along_z(1, without_jumps), mesh).surface_tets, nullptr);
    const auto tets = measure_data(along_z(1, jump(.3, .1, .6)), mesh).surface_tets;
    ASSERT_NE(tets, nullptr);
    EXPECT_EQ(tets->size(), mesh.mesh.tets().size() / 2);
    for (const std::int32_t tet : *tets)
        for (const glm::dvec3& corner : mesh.mesh.corners(tet)) EXPECT_LE(corner.x, 1);
    Scene scene = along_z(1, without_jumps);
    scene.nan = NanPolicy::transparent;
    mesh.scalar.values[26] = NAN;  // the corner (2, 2, 2)
    const auto beside = measure_data(scene, mesh).surface_tets;
    ASSERT_NE(beside, nullptr);
    EXPECT_LT(beside->size(), mesh.mesh.tets().size() / 2);
}

// A bound that is smaller than the roundings of colours adds to them.
TEST(SurfaceRays, CountHoweverLittleTheyChange) {
    const SceneMesh mesh = ramp_box();
    const Scene scene = along_z(2.1, without_jumps);
    MeshFacts facts = measure(scene, mesh);
    const auto claimed = [&](double error) {
        facts.surface_error = error / 255;
        return make_plan(scene, facts, cpu_capabilities(), {}, nullptr).error();
    };
    ASSERT_EQ(claimed(0).kind, ErrorKind::sampled);
    EXPECT_NEAR(claimed(.03).value - claimed(0).value, .03, 1e-12);
}

TEST(SurfaceRays, BesideTetsWithoutAValueAreInABoundary) {
    SceneMesh mesh = ramp_box();
    Scene scene = along_z(1, without_jumps);
    EXPECT_EQ(surface_error(mesh, scene), 0);
    for (std::size_t i = 0; i < mesh.scalar.values.size(); ++i)
        if (mesh.mesh.points()[i].x > 1.5) mesh.scalar.values[i] = NAN;
    scene.nan = NanPolicy::transparent;
    EXPECT_GT(surface_error(mesh, scene), 0);
}

class SurfaceRayPictures : public ProjectionTest {};

// Rays in the faces of a hole, along its diagonals, and of a box: single pixels are off by up to
// full scale, because tracer and renderer put them on different sides.
TEST_P(SurfaceRayPictures, ClaimNoErrorAlongTheBoundaryOfAMesh) {
    const SceneMesh mesh = scene_mesh(
        test::carved(test::kuhn_box({3, 3, 3}, [](const glm::dvec3& p) { return p.x; }),
                     [](const glm::dvec3& p) { return p.x < p.y || std::floor(p.z) != 1; }));
    Scene scene =
        along_z(1.5, TransferFunction::linear({knot(0, {1, .5, .2}, 1), knot(3, {.3, .5, 1}, 4)}));
    scene.width = scene.height = 33;
    scene.camera->eye.y = scene.camera->center.y = 1.5;
    scene.camera->height = 4.1;
    const Plan plan = plan_of(mesh, scene, capabilities());
    EXPECT_EQ(plan.error().kind, ErrorKind::unknown);
    EXPECT_EQ(plan.project.error_of_others.kind, ErrorKind::sampled);
    EXPECT_THAT(explain(plan, measure(scene, mesh), capabilities()),
                testing::HasSubstr("unknown of rays that run along the mesh's boundary"));
    // Moved aside, the eye is in none of these planes.
    scene.camera->eye += glm::dvec3(.011, .027, 0);
    scene.camera->center += glm::dvec3(.011, .027, 0);
    const ErrorFigure claimed = plan_of(mesh, scene, capabilities()).error();
    ASSERT_EQ(claimed.kind, ErrorKind::sampled);
    EXPECT_LE(image_error(project(mesh, scene, capabilities()), trace(mesh, scene)).all.linf,
              claimed.value);
}

TEST_P(SurfaceRayPictures, ClaimNoErrorAlongAJumpThatExceedsMaxError) {
    const SceneMesh mesh = ramp_box();
    for (const double level : {.3, .7, 1.1, 1.7}) {
        Scene scene = along_z(level, jump(level, .1, 2));
        const ErrorFigure unknown = plan_of(mesh, scene, capabilities()).error();
        EXPECT_EQ(unknown.kind, ErrorKind::unknown) << level;
        // A jump by a depth of .001 over the diagonal may change .255 / 255.
        scene = along_z(level, jump(level, .1, .1 + .001 / diagonal));
        const ErrorFigure claimed = plan_of(mesh, scene, capabilities()).error();
        ASSERT_EQ(claimed.kind, ErrorKind::sampled) << level;
        EXPECT_GT(claimed.value, .25) << level;
        EXPECT_LE(claimed.value, scene.max_error) << level;
        EXPECT_LE(image_error(project(mesh, scene, capabilities()), trace(mesh, scene)).all.linf,
                  claimed.value)
            << level;
    }
}

INSTANTIATE_TEST_SUITE_P(Engines, SurfaceRayPictures, every_engine, engine_name);

// The plane of a clip may run through the eye and a row of pixels. The tracer, which clips rays,
// has these inside; the mesh that is drawn was cut, and its rays are moved off its faces.
TEST(SurfaceRays, InThePlaneOfAClipHaveNoKnownError) {
    Scene scene = from_eye(1.04, without_jumps);
    scene.clip.planes = {{{1.04, 1.03, 5}, {0, -1, 0}}};
    const auto whole = std::make_shared<const SceneMesh>(ramp_box());
    const auto cut = clipped_mesh(whole, scene.clip, false, "mesh");
    EXPECT_EQ(plan_of(*cut, scene, cpu_capabilities()).error().kind, ErrorKind::unknown);
}

}  // namespace
}  // namespace lamina
