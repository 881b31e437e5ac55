// SPDX-License-Identifier: Apache-2.0
// Render targets: the codes or values that one slab leaves in each, and both compositing orders.
#include "base/error.h"
#include "engine_fixture.h"

namespace lamina {
namespace {

// One slab of an orthographic view of a constant volume: every pixel inside has the same opacity.
Scene one_slab(Target target, double opacity) {
    Scene scene =
        unit_box_scene(TransferFunction::linear({knot(0, {.25, .5, 1}, -std::log1p(-opacity))}),
                       Projection::orthographic, 8, 8);
    scene.camera->eye = {.5, .5, 3};
    scene.camera->up = {0, 1, 0};
    scene.camera->height = .5;
    scene.target = target;
    scene.slice.samples = 1;
    return scene;
}

TEST_F(SlicingTest, FixedTargetsHoldTheNearestCode) {
    const Volume volume =
        generate({"constant", std::array<std::int64_t, 3>{4, 4, 4}, SampleType::uint8});
    for (const double opacity : {.002, .01, .3, .5, .73, .999}) {
        for (const auto& [target, codes] :
             {std::pair{Target::fixed8, 255.}, std::pair{Target::fixed16, 65535.}}) {
            const Image image = render(volume, one_slab(target, opacity), capabilities());
            const double expected[] = {.25 * opacity, .5 * opacity, opacity, opacity};
            for (std::size_t channel = 0; channel < 4; ++channel) {
                const double code = codes * image.pixel(3, 3)[channel];
                EXPECT_NEAR(code, std::round(code), 1e-2);
                // Half a code for rounding to the code, and .02 for roundings of float32 before it
                // (2e-7 of 65535 codes).
                EXPECT_NEAR(code, codes * expected[channel], .5 + .02);
            }
        }
    }
}

TEST_F(SlicingTest, Float16TargetIsGoodToElevenBits) {
    const Volume volume =
        generate({"constant", std::array<std::int64_t, 3>{4, 4, 4}, SampleType::uint8});
    const Image image = render(volume, one_slab(Target::float16, .3), capabilities());
    EXPECT_NEAR(image.pixel(2, 2)[3], .3,
                .3 / 1024);  // drivers may truncate: one unit in the last place
    EXPECT_NE(image.pixel(2, 2)[3], .3f);
}

TEST_F(SlicingTest, BothOrdersGiveTheSamePicture) {
    const Volume volume = gaussians(32);
    Scene scene = unit_box_scene(smooth_transfer_function(), Projection::perspective);
    scene.slice.samples = 150;
    const Image back_to_front = render(volume, scene, capabilities());
    scene.slice.order = Order::front_to_back;
    // 150 roundings of float32 in each.
    EXPECT_LE(image_error(back_to_front, render(volume, scene, capabilities())).all.linf,
              255 * 150 * 1.2e-7);
}

TEST_P(BothEngines, NanCellsAreTransparentIfAskedFor) {
    Grid grid = reference_test::make_grid({12, 12, 12}, Centering::node, glm::dvec3(1. / 11));
    std::vector<float> samples(12 * 12 * 12);
    for (std::size_t i = 0; i < samples.size(); ++i) samples[i] = static_cast<float>(i % 12) / 11;
    samples[6 * 144 + 6 * 12 + 6] = NAN;
    samples[3 * 144 + 8 * 12 + 2] = INFINITY;
    const Volume volume = reference_test::make_volume(grid, samples);
    Scene scene = unit_box_scene(smooth_transfer_function(), Projection::perspective);
    scene.nan = NanPolicy::transparent;
    scene.slice.samples = 800;
    const Image reference = trace(volume, scene, 1e-6);
    for (const Classification classification :
         {Classification::post, Classification::preintegrated}) {
        for (const Capabilities& can : ways()) {
            scene.slice.classification = classification;
            // A segment across the border of a transparent cell is off by its own opacity: at most
            // extinction 6 over two segments of 1.8 / 800.
            EXPECT_LE(linf(draw(volume, scene, {}, can), reference), 255 * 6 * 4 * 1.8 / 800);
        }
    }
    scene.nan = NanPolicy::error;
    EXPECT_THROW(draw(volume, scene), Error);
}

}  // namespace
}  // namespace lamina
