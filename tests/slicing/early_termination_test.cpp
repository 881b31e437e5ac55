// SPDX-License-Identifier: Apache-2.0
// Rays end early when what lies behind changes the picture by less than 1/1024 of max_error.
#include <random>

#include "cpu_fixture.h"
#include "support/volume_of.h"

namespace lamina {
namespace {

class EarlyTerminationTest : public SlicingTest {
  protected:
    SlicePlan plan_of(const Volume& volume, const Scene& scene, bool tiles) const {
        const Facts facts = measure(scene, volume, measure_bricks(volume));
        return make_plan(scene, facts, tiles ? cpu_capabilities() : capabilities(), {}).slice;
    }

    bool ends_early(const Volume& volume, const Scene& scene) const {
        const bool tiles = plan_of(volume, scene, true).ends_early();
        EXPECT_EQ(plan_of(volume, scene, false).ends_early(), tiles);
        return tiles;
    }

    // Compares with rays that do not end. The bound is what lies behind the end, transmittance
    // times the largest colour, at most max_error / 1024; and the roundings of a float32 picture.
    void expect_bound(const Volume& volume, const Scene& scene, const std::string& what) const {
        const OmissionSwitch all = keep("early_termination");
        double largest = 1;
        for (const TransferKnot& each : scene.transfer_function->knots())
            largest =
                std::max({largest, each.optics.color.r, each.optics.color.g, each.optics.color.b});
        const double bound = scene.max_error / 1024 + 255 * largest * 1.2e-7;
        EXPECT_LE(
            image_error(render_tiles(volume, scene), render_tiles(volume, scene, all)).all.linf,
            bound)
            << what;
        EXPECT_LE(image_error(render(volume, scene, capabilities()),
                              render(volume, scene, capabilities(), all))
                      .all.linf,
                  bound)
            << what;
    }
};

Scene fog(double extinction, const glm::dvec3& color = {.3, .9, .5}) {
    Scene scene = unit_box_scene(
        TransferFunction::linear({knot(0, color, extinction), knot(1, {1, .2, .1}, extinction)}),
        Projection::orthographic, 45, 39);
    scene.slice.samples = 400;
    return scene;
}

TEST_F(EarlyTerminationTest, KeepsItsBoundInRandomScenes) {
    std::mt19937 random(4);
    std::uniform_real_distribution<double> place(-1, 2), unit(0, 1);
    for (int trial = 0; trial < 12; ++trial) {
        const Volume volume = test::noise(
            reference_test::make_grid({23, 31, 17}, Centering::node, glm::dvec3(1. / 30)),
            static_cast<std::uint32_t>(trial));
        std::vector<TransferKnot> knots;
        for (int i = 0; i < 6; ++i)
            knots.push_back(
                knot(51 * i, {unit(random), unit(random), trial % 2 == 0 ? 1 : 40 * unit(random)},
                     i < 2 ? 0 : 400 * unit(random)));
        Scene scene = unit_box_scene(
            TransferFunction::linear(knots),
            trial % 3 == 0 ? Projection::orthographic : Projection::perspective, 45, 39);
        scene.camera->eye = {place(random), place(random), place(random)};
        scene.camera->center = {.4, .5, .3};
        scene.slice.samples = 200;
        scene.max_error = trial % 4 == 3 ? 8 : 1;
        scene.slice.classification =
            trial % 2 == 0 ? Classification::preintegrated : Classification::post;
        ASSERT_TRUE(ends_early(volume, scene));
        expect_bound(volume, scene, std::to_string(trial));
    }
}

// With a single colour, only opacity is marched.
TEST_F(EarlyTerminationTest, KeepsItsBoundWithOneColor) {
    Scene scene = fog(60, {1, .2, .1});
    scene.transfer_function =
        TransferFunction::linear({knot(0, {1, .2, .1}, 20), knot(1, {1, .2, .1}, 80)});
    const Volume volume = gaussians(24);
    ASSERT_TRUE(plan_of(volume, scene, true).single_color);
    ASSERT_TRUE(ends_early(volume, scene));
    expect_bound(volume, scene, "one colour");
}

// Counts the segments that are evaluated. A ray of depth 100 and more ends before half of it, at
// the latest a block of 32 slabs behind depth 12.5 = ln(255 * 1024), which is 23 slabs here.
TEST_F(EarlyTerminationTest, LeavesOutWhatLiesBehind) {
    const Volume volume = gaussians(24);
    const Scene scene = fog(130);  // 400 slabs over the depth of the box, 1.7 or so: .55 a slab
    const OmissionSwitch all = keep("early_termination");
    const View view(*scene.camera, scene.width, scene.height);
    const auto some = cpu_renderer(volume, scene), every = cpu_renderer(volume, scene, all);
    some->draw(view);
    every->draw(view);
    EXPECT_LT(some->fragments(), every->fragments() / 2);
}

// Rays do not end early if no ray is deep enough, nor if something of a colour of 1e4 lies behind,
// which shows through where a colour of 1 would not.
TEST_F(EarlyTerminationTest, LeavesOutNothingThatShows) {
    const Volume volume = gaussians(24);
    const Facts facts = measure(fog(1), volume, measure_bricks(volume));
    const double depth = std::log(255 * 1024.) / (facts.far_depth - facts.near_depth);
    EXPECT_FALSE(ends_early(volume, fog(.99 * depth)));
    EXPECT_FALSE(ends_early(volume, fog(1.01 * depth)));
    EXPECT_TRUE(ends_early(volume, fog(2 * depth)));

    const Volume ramp = test::volume_of<float>(
        reference_test::make_grid({65, 9, 9}, Centering::node, glm::dvec3(1. / 64)),
        [](double i, double, double) { return i / 64; });
    Scene scene = fog(1);
    scene.camera->eye = {-2, .06, .06};
    scene.camera->center = {.5, .0625, .0625};
    scene.camera->height = .1;
    // An optical depth of 11 lies in front of the colour 1e4: 1e4 exp(-11), a sixth of full scale,
    // shows through, in a picture in which 1 / 255 / 1024 counts.
    scene.transfer_function = TransferFunction::linear(
        {knot(0, {1, 0, 0}, 22), knot(.5, {1, 0, 0}, 22), knot(.5, {1, 1e4, 1}, 60)});
    ASSERT_TRUE(ends_early(ramp, scene));
    expect_bound(ramp, scene, "bright");
    const Image image = render_tiles(ramp, scene);
    EXPECT_GT(image.pixel(22, 19)[1], .1f);

    // Nearly that colour just below the largest value, at which there is a step; the ramp ends in a
    // plateau of the largest value.
    const Volume plateau = test::volume_of<float>(
        ramp.grid(), [](double i, double, double) { return std::min(i / 32, 1.); });
    scene.transfer_function =
        TransferFunction::linear({knot(0, {1, 0, 0}, 28), knot(.9, {1, 0, 0}, 28),
                                  knot(1, {1, 1e4, 1}, 28), knot(1, {1, 0, 0}, 60)});
    ASSERT_TRUE(ends_early(plateau, scene));
    expect_bound(plateau, scene, "bright below the largest value");
}

// Rays do not end early if slabs are blended one after the other, or in trees of several levels.
TEST_F(EarlyTerminationTest, AppliesOnlyToRaysMarchedAsAWhole) {
    const Volume volume = gaussians(24);
    Scene scene = fog(130);
    scene.slice.tree = TreeSettings{.factors = {8, 8}};
    EXPECT_FALSE(ends_early(volume, scene));
    scene.slice.tree = TreeSettings{.factors = {400}};
    EXPECT_TRUE(ends_early(volume, scene));
    scene.slice.tree.reset();
    scene.target = Target::fixed8;
    EXPECT_FALSE(ends_early(volume, scene));
}

}  // namespace
}  // namespace lamina
