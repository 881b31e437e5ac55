// SPDX-License-Identifier: Apache-2.0
// The error that exact segments claim of rays that run along a surface at which the transfer
// function jumps: there a rounding of the scalar decides on which side of it a whole ray is.
#include <gmock/gmock.h>

#include <cmath>

#include "cpu_fixture.h"
#include "exact_fixture.h"
#include "plan/plan.h"

namespace lamina {
namespace {

// A field that rises along x from `from` in ten steps of `step`. Nothing else changes.
Volume ramp(double from, double step) {
    return test::volume_of<float>(test::grid_of({11, 5, 21}, Centering::node),
                                  [&](double x, double, double) { return from + step * x; });
}

// Parallel rays along z, whose middle column runs in the middle of the cells between x and x + 1.
Scene along_surface(double x, const TransferFunction& transfer_function) {
    Scene scene = exact_scene(transfer_function, Projection::orthographic);
    scene.camera->eye = {x + .5, 2.2, -5};
    scene.camera->center = {x + .5, 2.2, 5};
    scene.camera->up = {0, 1, 0};
    scene.camera->height = 3;
    scene.width = 5;
    scene.height = 3;
    return scene;
}

// A transfer function that jumps at `value`, by this optical depth over the whole length of a ray.
// It changes from .31 below to .93 above, so that `value` is no round number of the window.
TransferFunction jump(double value, double depth) {
    const double after = .01 + depth / 20;
    return TransferFunction::linear(
        {knot(value - .31, {.3, .2, .1}, .009), knot(value, {.3, .2, .1}, .01),
         knot(value, {.3, .2, .1}, after), knot(value + .93, {.3, .2, .1}, 1.02 * after)});
}

ErrorFigure claimed(const Volume& volume, const Scene& scene) {
    const Facts facts = measure(scene, volume, measure_bricks(volume));
    return make_plan(scene, facts, cpu_capabilities(), {}).error();
}

// Calls visit(volume, scene) for rays in many surfaces, each of which a rounding may miss.
template <typename Visit>
void for_each_surface(double depth, const Visit& visit) {
    for (const double from : {0., .37, 1.12}) {
        for (const double step : {.1, .07, .013}) {
            const Volume volume = ramp(from, step);
            for (int x = 0; x < 10; ++x)
                visit(volume, along_surface(x, jump(from + step * (x + .5), depth)));
        }
    }
}

TEST(SurfaceError, IsNotClaimedIfItMayExceedMaxError) {
    double worst = 0;
    for_each_surface(4, [&](const Volume& volume, const Scene& scene) {
        EXPECT_EQ(claimed(volume, scene).kind, ErrorKind::unknown);
        worst = std::max(worst, linf(render_tiles(volume, scene), trace(volume, scene, 1e-8)));
    });
    EXPECT_GT(worst, 100);
}

TEST(SurfaceError, KeepsABoundBelowMaxError) {
    double worst = 0;
    for_each_surface(.003, [&](const Volume& volume, const Scene& scene) {
        const ErrorFigure claim = claimed(volume, scene);
        ASSERT_EQ(claim.kind, ErrorKind::derived);
        EXPECT_LE(claim.value, scene.max_error);
        const double error = linf(render_tiles(volume, scene), trace(volume, scene, 1e-8));
        EXPECT_LE(error, claim.value);
        worst = std::max(worst, error);
    });
    EXPECT_GT(worst, exact_segment_error);
}

// A jump of colour counts by the share of a ray's light that has it.
TEST(SurfaceError, CountsJumpsOfColor) {
    const Volume volume = ramp(0, .1);
    const auto claim_at = [&](double extinction) {
        return claimed(
            volume, along_surface(3, TransferFunction::linear({knot(.35, {1, 0, 0}, extinction),
                                                               knot(.35, {0, 0, 1}, extinction)})));
    };
    EXPECT_EQ(claim_at(.2).kind, ErrorKind::unknown);
    EXPECT_EQ(claim_at(1e-4).kind, ErrorKind::derived);
    EXPECT_GT(claim_at(1e-4).value, 255 * 20 * 1e-4);  // the box is 20 deep
}

// The rule that cuts lit rays limits what each piece errs by, but not how many faint pieces there
// are, so its figure is no bound. Without light it is one.
TEST(SurfaceError, OfLitRaysIsAnEstimate) {
    const Volume volume = ramp(0, .1);
    Scene scene = along_surface(
        3, TransferFunction::linear({knot(0, {1, 0, 0}, .1), knot(1, {0, 0, 1}, .4)}));
    EXPECT_EQ(claimed(volume, scene).kind, ErrorKind::derived);
    Lighting lighting;
    lighting.smallest_gradient = .01;
    scene.lighting = lighting;
    EXPECT_EQ(claimed(volume, scene).kind, ErrorKind::estimated);
    EXPECT_GT(claimed(volume, scene).value, .5 * scene.max_error);
}

// A block of the largest value, in whose faces rays run: the later side of a step at that value
// shows in the block and in its faces, but a rounding beside them would not meet it.
TEST(SurfaceError, CountsStepsAtTheEndsOfTheSamples) {
    const auto inside = [](double i) { return i >= 2 && i <= 6; };
    const Volume block = test::volume_of<std::uint8_t>(
        test::grid_of({9, 9, 9}, Centering::node), [&](double x, double y, double z) {
            return inside(x) && inside(y) && inside(z) ? 255. : 0.;
        });
    for (const double value : {0., 255.}) {
        const Scene scene = along_surface(5.5, jump(value, 4));
        EXPECT_EQ(claimed(block, scene).kind, ErrorKind::unknown) << value;
    }
}

// Voxels of one value each, seen along an axis: with an even number of voxels and an odd number of
// pixels, the middle column of rays runs in the faces between two. The same in perspective.
TEST(SurfaceError, IsNotClaimedInFacesBetweenVoxels) {
    Grid grid = test::grid_of({8, 6, 4}, Centering::cell);
    grid.lookup = VolumeLookup::nearest;
    const Volume volume =
        test::volume_of<float>(grid, [](double x, double y, double z) { return x + y + z; });
    const TransferFunction transfer_function =
        TransferFunction::linear({knot(0, {1, 0, 0}, .1), knot(16, {0, 0, 1}, .9)});
    for (const Projection projection : {Projection::orthographic, Projection::perspective}) {
        Scene scene = exact_scene(transfer_function, projection);
        const glm::dvec3 middle = volume.grid().to_world({4, 2.7, 1.3});
        scene.camera->center = middle;
        scene.camera->eye = middle - glm::dvec3(0, 0, 20);
        scene.camera->up = {0, 1, 0};
        scene.camera->height = 4.4;
        scene.height = 10;
        scene.width = 15;
        EXPECT_EQ(claimed(volume, scene).kind, ErrorKind::unknown);
        scene.width = 14;
        EXPECT_EQ(claimed(volume, scene).kind, ErrorKind::derived);
        scene.width = 15;
        scene.camera->eye.x += 1e-3;
        scene.camera->center.x += 1e-3;
        EXPECT_EQ(claimed(volume, scene).kind, ErrorKind::derived);
    }
}

// A steep ramp may change a ray along its foot by more than max_error, but it is no jump: what is
// stated holds of all other rays, and the bound of these stands beside it.
TEST(SurfaceError, OfRampsIsSaidBesideThatOfAllOtherRays) {
    const Volume volume = ramp(0, .1);
    const Scene scene = along_surface(
        3, TransferFunction::linear({knot(.35, {1, 1, 1}, 0), knot(.85, {1, 1, 1}, 2e4)}));
    const Facts facts = measure(scene, volume, measure_bricks(volume));
    const Plan plan = make_plan(scene, facts, cpu_capabilities(), {});
    EXPECT_EQ(plan.error().kind, ErrorKind::derived);
    EXPECT_LE(plan.error().value, exact_segment_error + 1. / 512);
    // 255 (1 - exp(-dt l)) with dt = 2e4 2^-22 / .5, as the window is 1 wide, and l of the box of
    // 10 by 4 by 20 at most.
    const double change = 2e4 * 0x1p-22 / .5 * std::hypot(10, 4, 20);
    EXPECT_GT(plan.slice.ramp_error, scene.max_error);
    EXPECT_LE(plan.slice.ramp_error, -255 * std::expm1(-change));
    EXPECT_DOUBLE_EQ(plan.error().along_ramps, plan.error().value + plan.slice.ramp_error);
    EXPECT_THAT(explain(plan, facts, cpu_capabilities()),
                testing::HasSubstr("; along ramps at most"));
}

TEST(SurfaceError, OfRampsThatFitsIsPartOfTheError) {
    const Scene scene = along_surface(
        3, TransferFunction::linear({knot(.35, {1, 1, 1}, 0), knot(.85, {1, 1, 1}, 20)}));
    EXPECT_EQ(claimed(ramp(0, .1), scene).along_ramps, 0);
}

TEST(SurfaceError, IsSmallWithoutSteps) {
    const Scene scene =
        along_surface(3, TransferFunction::linear({knot(.2, {1, 0, 0}, 0), knot(.5, {0, 1, 0}, .4),
                                                   knot(.6, {0, 0, 1}, 0)}));
    // And where rays end early.
    EXPECT_LE(claimed(ramp(0, .1), scene).value, exact_segment_error + 1. / 512);
}

}  // namespace
}  // namespace lamina
