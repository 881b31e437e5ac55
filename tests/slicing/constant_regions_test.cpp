// SPDX-License-Identifier: Apache-2.0
// Regions of one colour and one extinction, which the cpu engine's marched rays cross in one step.
#include <random>

#include "cpu_fixture.h"
#include "support/volume_of.h"

namespace lamina {
namespace {

Facts facts_of(const Volume& volume, const Scene& scene) {
    return measure(scene, volume, measure_bricks(volume));
}

bool takes_regions(const Volume& volume, const Scene& scene) {
    return make_plan(scene, facts_of(volume, scene), cpu_capabilities(), {}).slice.constant_regions;
}

Grid unit_grid(std::int64_t edge, Centering centering = Centering::node) {
    return reference_test::make_grid({edge, edge, edge}, centering,
                                     glm::dvec3(1 / static_cast<double>(edge - 1)));
}

// Noise in the lower half; in the upper half 40 and 200, with a ramp between.
Volume layered(std::int64_t edge = 41, Centering centering = Centering::node) {
    std::mt19937 random(3);
    return test::volume_of<std::uint8_t>(
        unit_grid(edge, centering), [&](double x, double, double z) {
            if (2 * z < static_cast<double>(edge)) return static_cast<double>(random() % 256);
            return std::clamp(40 * (x - .4 * static_cast<double>(edge)), 40.0, 200.0);
        });
}

// Returns transfer functions of one piece, of several, of one colour, and with a plateau.
std::vector<TransferFunction> transfer_functions() {
    return {TransferFunction::linear({knot(0, {.1, .9, .3}, 1), knot(255, {1, .1, .6}, 9)}),
            TransferFunction::linear({knot(0, {.1, .9, .3}, 0), knot(60, {.5, .9, .3}, 3),
                                      knot(61, {.2, .9, .3}, 0), knot(255, {1, .1, .6}, 9)}),
            TransferFunction::linear({knot(0, {.5, .9, .3}, 1), knot(255, {.5, .9, .3}, 9)}),
            TransferFunction::linear({knot(0, {0, 0, 1}, 0), knot(30, {.1, .9, .3}, 4),
                                      knot(220, {.1, .9, .3}, 4), knot(255, {1, .1, .6}, 9)})};
}

// Returns the largest difference in 1/255 between a region crossed in one step and slab by slab. A
// sum of N segments rounds N times, by at most 6e-8 of the sum of opacities, which is up to 1.
// Roundings of scalars and lengths change an optical depth by 1e-6 of itself, and the opacity by
// less, since depth * exp(-depth) < .4. Tables differ by up to .0026 (linear_segments_test.cpp) for
// deep segments; here segments are at most 9 / 100 deep.
double bound(const Scene& scene) {
    const bool table = scene.slice.classification == Classification::preintegrated;
    return 255 * (1e-7 * *scene.slice.samples + 1e-6 + (table ? 1e-5 : 0));
}

TEST(ConstantRegionsTest, KeepThePicture) {
    for (const Centering centering : {Centering::node, Centering::cell}) {
        const Volume volume = layered(41, centering);
        for (const TransferFunction& transfer_function : transfer_functions()) {
            for (const Classification classification :
                 {Classification::post, Classification::preintegrated}) {
                for (const Projection projection :
                     {Projection::orthographic, Projection::perspective}) {
                    Scene scene = unit_box_scene(transfer_function, projection);
                    scene.slice.classification = classification;
                    scene.slice.samples = 150;
                    ASSERT_TRUE(takes_regions(volume, scene));
                    for (const std::uint64_t texture_bytes : {1 << 30, 60000}) {
                        Capabilities tiles = cpu_capabilities();
                        tiles.max_texture_bytes = texture_bytes;
                        const Image all =
                            render_tiles(volume, scene, keep("constant_regions"), tiles);
                        EXPECT_LE(image_error(render_tiles(volume, scene, {}, tiles), all).all.linf,
                                  bound(scene));
                    }
                }
            }
        }
    }
}

// Compares with the tracer.
TEST(ConstantRegionsTest, AreExact) {
    const Volume volume = test::volume_of<std::uint8_t>(
        unit_grid(33), [](double x, double, double) { return x < 16 ? 40 : 200; });
    const TransferFunction steps =
        TransferFunction::linear({knot(0, {.1, .9, .3}, 1), knot(39, {.1, .9, .3}, 1),
                                  knot(201, {.9, .2, .3}, 7), knot(255, {.9, .2, .3}, 7)});
    Scene scene = unit_box_scene(steps, Projection::perspective);
    scene.slice.samples = 2000;
    ASSERT_TRUE(takes_regions(volume, scene));
    // The midpoint rule has no error but at the two kinks of the ramp between the regions: h^2 / 8
    // of the slope of colour * extinction, .8 * 32 * 7 + .9 * 32 * 6 per unit of length.
    const double h = 2.5 / 2000;
    const double slabs = 255 * 2 * 352 * h * h / 8;
    EXPECT_LE(image_error(render_tiles(volume, scene), trace(volume, scene, 1e-8)).all.linf,
              slabs + bound(scene));
}

// Extinctions beyond float's range. A ray that misses the region has a length of 0 in it, and 0 *
// infinity must not occur.
TEST(ConstantRegionsTest, StayFiniteWithExtremeExtinction) {
    const Volume volume = layered();
    Scene scene = unit_box_scene(
        TransferFunction::linear({knot(0, {.1, .9, .3}, 0), knot(255, {1, .1, .6}, 1e300)}),
        Projection::orthographic);
    scene.slice.samples = 150;
    ASSERT_TRUE(takes_regions(volume, scene));
    const Image image = render_tiles(volume, scene);
    EXPECT_TRUE(std::ranges::all_of(image.rgba, [](float v) { return std::isfinite(v); }));
    EXPECT_LE(image_error(image, render_tiles(volume, scene, keep("constant_regions"))).all.linf,
              bound(scene));
}

// Leaves of trees are marched, so regions are crossed in one step; targets with codes need every
// slab's own code.
TEST(ConstantRegionsTest, AreTakenInTreesButNotWithCodes) {
    const Volume volume = layered();
    Scene scene = unit_box_scene(transfer_functions().front(), Projection::orthographic);
    scene.slice.samples = 150;
    scene.slice.tree = TreeSettings{};
    (*scene.slice.tree)->factors = {5, 30};
    ASSERT_TRUE(takes_regions(volume, scene));
    EXPECT_LE(image_error(render_tiles(volume, scene),
                          render_tiles(volume, scene, keep("constant_regions")))
                  .all.linf,
              bound(scene) + 255 * 5 * 3e-7);
    scene.slice.tree.reset();
    scene.target = Target::emulated;
    EXPECT_FALSE(takes_regions(volume, scene));
}

// Regions that are almost constant are sampled: with one differing sample, with a slope of 1e-12,
// with a step exactly at the region's value, and with NaN samples.
TEST(ConstantRegionsTest, ExcludeWhatIsOnlyNearlyConstant) {
    const auto volume_of = [](float inside, float other) {
        std::vector<float> samples(33 * 33 * 33, inside);
        samples[16 * 1089 + 16 * 33 + 17] = other;
        samples[0] = 0;
        return reference_test::make_volume(unit_grid(33), samples);
    };
    const TransferFunction line =
        TransferFunction::linear({knot(0, {.1, .9, .3}, 0), knot(255, {1, .1, .6}, 9)});
    Scene scene = unit_box_scene(line, Projection::orthographic);
    scene.slice.samples = 150;
    const Volume volume = volume_of(100, 100.5f);
    const ConstantBricks bricks = facts_of(volume, scene).constant_bricks;
    ASSERT_EQ(bricks.kinds.size(), 1u);
    EXPECT_EQ(bricks.varied.distance_at(4, 4, 4), 0);
    EXPECT_EQ(bricks.varied.distance_at(4, 3, 3), 0);  // shares the sample
    EXPECT_EQ(bricks.varied.distance_at(5, 4, 4), 1);
    EXPECT_LE(image_error(render_tiles(volume, scene),
                          render_tiles(volume, scene, keep("constant_regions")))
                  .all.linf,
              bound(scene));

    std::mt19937 random(7);
    const Volume noise = test::volume_of(unit_grid(33), [&](double, double, double) {
        return std::uniform_real_distribution<double>(90, 110)(random);
    });
    const auto plateau = [](double extinction) {
        return TransferFunction::linear({knot(0, {.1, .9, .3}, 0), knot(80, {.5, .5, .5}, 3),
                                         knot(120, {.5, .5, .5}, extinction),
                                         knot(255, {1, .1, .6}, 9)});
    };
    scene.transfer_function = plateau(3);
    EXPECT_TRUE(facts_of(noise, scene).constant);  // the whole volume
    const Volume wider = volume_of(100, 200);
    EXPECT_TRUE(takes_regions(wider, scene));
    scene.transfer_function = plateau(3 + 1e-12);
    EXPECT_FALSE(takes_regions(noise, scene));

    scene.transfer_function = TransferFunction::linear(
        {knot(0, {.1, .9, .3}, 1), knot(100, {.1, .9, .3}, 1), knot(100, {.9, .1, .3}, 5)});
    EXPECT_FALSE(takes_regions(volume_of(100, 200), scene));
    EXPECT_TRUE(takes_regions(volume_of(101, 200), scene));

    scene.transfer_function = line;
    scene.nan = NanPolicy::transparent;
    EXPECT_FALSE(takes_regions(volume_of(100, NAN), scene));
}

// Blocks of labels, sometimes of more kinds than are kept, and noise, with random transfer
// functions and views.
TEST(ConstantRegionsTest, KeepThePictureOfRandomScenes) {
    std::mt19937 random(11);
    const auto uniform = [&] { return std::uniform_real_distribution<double>(0, 1)(random); };
    int taken = 0;
    for (int round = 0; round < 30; ++round) {
        const int labels = 2 + static_cast<int>(random() % 30),
                  block = 6 + static_cast<int>(random() % 12);
        const auto edge = static_cast<std::int64_t>(25 + random() % 40);
        std::vector<double> label(12 * 12 * 12);
        for (double& value : label) value = std::floor(labels * uniform());
        const Volume volume =
            test::volume_of<std::uint8_t>(unit_grid(edge), [&](double x, double y, double z) {
                const auto place = [&](double v) { return static_cast<std::size_t>(v / block); };
                const double value = label[(place(z) * 12 + place(y)) * 12 + place(x)];
                return value == 0 ? std::floor(labels * uniform()) : value;
            });
        std::vector<TransferKnot> knots;
        for (int i = 0; i < 2 + round % 5; ++i)
            knots.push_back(knot(i * labels / 4.0, {uniform(), uniform(), uniform()},
                                 random() % 4 == 0 ? 0 : 20 * uniform()));
        Scene scene = unit_box_scene(
            round % 3 == 0 ? TransferFunction::nearest(knots) : TransferFunction::linear(knots),
            round % 2 == 0 ? Projection::perspective : Projection::orthographic);
        scene.camera->eye = {4 * uniform() - 1.5, 4 * uniform() - 1.5, 4 * uniform() - 1.5};
        scene.slice.samples = 20 + static_cast<int>(random() % 300);
        if (!takes_regions(volume, scene)) continue;
        ++taken;
        EXPECT_LE(image_error(render_tiles(volume, scene),
                              render_tiles(volume, scene, keep("constant_regions")))
                      .all.linf,
                  bound(scene))
            << round;
    }
    EXPECT_GT(taken, 10);
}

}  // namespace
}  // namespace lamina
