// SPDX-License-Identifier: Apache-2.0
// Pre-integrated segments in closed form: no table is needed if the transfer function is one linear
// piece.
#include <random>

#include "cpu_fixture.h"
#include "support/volume_of.h"

namespace lamina {
namespace {

// A field that is linear in space, and so along every segment: slabs are exact for any number of
// them.
Volume ramp() {
    const Grid grid = reference_test::make_grid({2, 2, 2}, Centering::node);
    const std::vector<float> samples{0, .2f, .1f, .3f, .7f, .9f, .8f, 1};
    return reference_test::make_volume(grid, samples);
}

TransferFunction line(double extinction) {
    return TransferFunction::linear(
        {knot(0, {.1, .9, .3}, .2 * extinction), knot(1, {1, .1, .6}, extinction)});
}

Scene scene_of(const TransferFunction& transfer_function, Projection projection, int samples) {
    Scene scene = unit_box_scene(transfer_function, projection);
    scene.slice.classification = Classification::preintegrated;
    scene.slice.samples = samples;
    return scene;
}

Plan plan_of(const Volume& volume, const Scene& scene, const OmissionSwitch& omissions = {}) {
    return make_plan(scene, measure(scene, volume, measure_bricks(volume)), cpu_capabilities(),
                     omissions);
}

// The weight of a segment's front is off by at most 3e-5 (optics/segment_integral.h), which along a
// ray adds up to as much times the colour's change, here less than 1. A slab's products and sums in
// float are off by some 2e-7 of 1. Scalars, and with them a ray's optical depth, are off by 1e-6 of
// themselves: depth * exp(-depth) < .4.
TEST_F(SlicingTest, LinearSegmentsAreExact) {
    const Volume volume = ramp();
    for (const Projection projection : {Projection::orthographic, Projection::perspective}) {
        for (const auto& [samples, extinction] :
             {std::pair(3, 1.8), std::pair(40, 20.0), std::pair(400, 1.0)}) {
            const Scene scene = scene_of(line(extinction), projection, samples);
            ASSERT_TRUE(plan_of(volume, scene).slice.linear);
            const Image traced = trace(volume, scene, 1e-7);
            const double bound = 255 * (3e-5 + 2e-7 * samples + 1e-6);
            EXPECT_LE(image_error(render_tiles(volume, scene), traced).all.linf, bound) << samples;
            EXPECT_LE(image_error(render(volume, scene, capabilities()), traced).all.linf, bound)
                << samples;
        }
    }
}

// Tables with layers of length have an error of up to .0025 (plan/slice_planner.cpp).
TEST_F(SlicingTest, LinearSegmentsMatchTheTable) {
    std::mt19937 random(5);
    const auto uniform = [&] { return std::uniform_real_distribution<double>(0, 1)(random); };
    for (int round = 0; round < 12; ++round) {
        std::vector<float> samples(7 * 6 * 5);
        for (float& sample : samples) sample = static_cast<float>(uniform());
        const Volume volume = reference_test::make_volume(
            reference_test::make_grid({7, 6, 5}, Centering::node, {1. / 6, 1. / 5, 1. / 4}),
            samples);
        const auto color = [&] { return glm::dvec3(uniform(), uniform(), uniform()); };
        const int slabs = 5 + static_cast<int>(random() % 60);
        const Scene scene =
            scene_of(TransferFunction::linear({knot(-.1, color(), round % 3 == 0 ? 0 : uniform()),
                                               knot(1.1, color(), .5 * slabs * uniform())}),
                     round % 2 == 0 ? Projection::perspective : Projection::orthographic, slabs);
        ASSERT_TRUE(plan_of(volume, scene).slice.linear);
        ASSERT_FALSE(plan_of(volume, scene, keep("table")).slice.linear);
        EXPECT_LE(
            image_error(render_tiles(volume, scene), render_tiles(volume, scene, keep("table")))
                .all.linf,
            255 * .0026);
        EXPECT_LE(image_error(render_tiles(volume, scene), render(volume, scene, capabilities()))
                      .all.linf,
                  255 * 2e-5);
    }
}

// Transfer functions of almost one piece, or segments that are almost thin enough, need a table.
TEST(LinearSegmentsTest, NeedATableIfAConditionIsOnlyNearlyMet) {
    const Volume volume = ramp();
    const auto is_linear = [&](const TransferFunction& transfer_function, int samples) {
        return plan_of(volume, scene_of(transfer_function, Projection::orthographic, samples))
            .slice.linear;
    };
    EXPECT_TRUE(is_linear(line(5), 100));
    // A knot inside, by very little; a step at the very end of the range.
    EXPECT_FALSE(is_linear(
        TransferFunction::linear(
            {knot(0, {.1, .9, .3}, 1), knot(1 - 1e-6, {.2, .9, .3}, 2), knot(1, {1, .1, .6}, 2)}),
        100));
    EXPECT_FALSE(
        is_linear(TransferFunction::linear({knot(0, {.1, .9, .3}, 1), knot(1, {.2, .9, .3}, 2),
                                            knot(1, {1, .1, .6}, 2)}),
                  100));
    // Knots outside of the range do not count.
    EXPECT_TRUE(is_linear(
        TransferFunction::linear({knot(-2, {.1, .9, .3}, 1), knot(-1e-6, {.1, .9, .3}, 1),
                                  knot(1 + 1e-6, {.2, .9, .3}, 2), knot(3, {1, .1, .6}, 9)}),
        100));
    // Segments of an optical depth of 1.45 are thin enough (thin_depth), those of 1.55 are not;
    // with one colour any depth is allowed.
    const Scene scene = scene_of(line(5), Projection::orthographic, 100);
    const Facts facts = measure(scene, volume, measure_bricks(volume));
    const double length = (facts.far_depth - facts.near_depth) / 100 * facts.max_length_per_depth;
    EXPECT_TRUE(is_linear(line(1.45 / length), 100));
    EXPECT_FALSE(is_linear(line(1.55 / length), 100));
    EXPECT_TRUE(is_linear(
        TransferFunction::linear({knot(0, {.1, .9, .3}, 1), knot(1, {.1, .9, .3}, 100 / length)}),
        100));
}

}  // namespace
}  // namespace lamina
