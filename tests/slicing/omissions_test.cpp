// SPDX-License-Identifier: Apache-2.0
// Leaving out what a scene does not need must not change its picture.
#include "engine_fixture.h"

namespace lamina {
namespace {

std::vector<std::string> omitted_in(const Volume& volume, const Scene& scene,
                                    const Capabilities& capabilities) {
    const Facts facts = measure(scene, volume, measure_bricks(volume));
    std::vector<std::string> names;
    for (const Omission& omission : make_plan(scene, facts, capabilities, {}).omitted)
        names.push_back(omission.name);
    return names;
}

double change(const Volume& volume, const Scene& scene, const Capabilities& capabilities) {
    return image_error(render(volume, scene, capabilities),
                       render(volume, scene, capabilities, leave_nothing_out()))
        .all.linf;
}

bool has(const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

TEST_P(BothEngines, EmptySpaceIsLeftOutBitForBit) {
    const Volume volume = gaussians(64);
    const TransferFunction top = TransferFunction::linear(
        {knot(.8, {.1, .5, .9}, 0), knot(.9, {.9, .5, .1}, 20), knot(1, {1, 1, 1}, 30)});
    for (const Classification classification :
         {Classification::post, Classification::preintegrated}) {
        for (const Projection projection : {Projection::orthographic, Projection::perspective}) {
            Scene scene = unit_box_scene(top, projection);
            scene.slice.classification = classification;
            scene.slice.samples = 37;
            ASSERT_TRUE(has(omitted_in(volume, scene, capabilities()), "empty_space"));
            EXPECT_EQ(linf(draw(volume, scene), draw(volume, scene, keep("empty_space"))), 0);
        }
    }
}

// One visible sample in an otherwise transparent volume must be drawn: the bricks around it are not
// empty.
TEST_F(SlicingTest, OneVisibleSampleIsDrawn) {
    Grid grid = reference_test::make_grid({70, 70, 70}, Centering::node, glm::dvec3(1. / 69));
    std::vector<std::uint8_t> samples(70 * 70 * 70, 10);
    samples[48 * 4900 + 48 * 70 + 48] = 12;
    const Volume volume = reference_test::make_volume(grid, samples);
    Scene scene =
        unit_box_scene(TransferFunction::linear({knot(11, {1, 1, 1}, 0), knot(12, {1, 1, 1}, 300)}),
                       Projection::orthographic, 200, 150);
    scene.slice.samples = 300;
    ASSERT_TRUE(has(omitted_in(volume, scene, capabilities()), "empty_space"));
    const Image image = render(volume, scene, capabilities());
    EXPECT_GT(*std::max_element(image.rgba.begin(), image.rgba.end()), .1f);
    OmissionSwitch keep_space;
    keep_space.kept = {"empty_space"};
    const Image whole = render(volume, scene, capabilities(), keep_space);
    EXPECT_EQ(image_error(image, whole).all.linf, 0);
}

TEST_F(SlicingTest, EachOmissionKeepsThePicture) {
    const Volume volume = gaussians(32);
    const TransferFunction grey =
        TransferFunction::linear({knot(0, {.7, .7, .7}, 0), knot(1, {.7, .7, .7}, 5)});
    Scene scene = unit_box_scene(grey, Projection::orthographic);
    scene.slice.samples = 400;
    scene.slice.classification = Classification::preintegrated;
    const auto names = omitted_in(volume, scene, capabilities());
    EXPECT_TRUE(has(names, "perspective"));
    EXPECT_TRUE(has(names, "color"));
    // Sums of 400 terms in another order of float32 operations.
    EXPECT_LE(change(volume, scene, capabilities()), 255 * 400 * 1.2e-7);

    // Faint segments: the optical depth of each is below .02, so its colour is off by at most .02 /
    // 12 of the range of colours.
    scene.transfer_function = TransferFunction::linear(
        {knot(0, {0, 0, 1}, 0), knot(.5, {.2, .8, 0}, 1), knot(1, {1, 0, 0}, 3)});
    EXPECT_TRUE(has(omitted_in(volume, scene, capabilities()), "length_layers"));
    EXPECT_LE(change(volume, scene, capabilities()), 255 * .02 / 12);

    scene.transfer_function =
        TransferFunction::linear({knot(0, {.2, .3, .4}, 2), knot(1, {.2, .3, .4}, 2)});
    EXPECT_TRUE(has(omitted_in(volume, scene, capabilities()), "volume_texture"));
    EXPECT_LE(change(volume, scene, capabilities()), 255 * 400 * 1.2e-7);

    scene.transfer_function =
        TransferFunction::linear({knot(0, {1, 1, 1}, 0), knot(2, {1, 1, 1}, 0)});
    EXPECT_TRUE(has(omitted_in(volume, scene, capabilities()), "drawing"));
    EXPECT_EQ(change(volume, scene, capabilities()), 0);
}

// Conditions that are almost met: these things must not be left out.
TEST_F(SlicingTest, NearlyMetConditionsLeaveNothingOut) {
    const Volume volume = gaussians(32);
    Scene scene = unit_box_scene(
        TransferFunction::linear({knot(0, {.5, .5, .5}, 0), knot(1, {.5, .5, .500001}, 5)}),
        Projection::perspective);
    auto names = omitted_in(volume, scene, capabilities());
    EXPECT_FALSE(has(names, "color"));
    EXPECT_FALSE(has(names, "perspective"));
    scene.transfer_function =
        TransferFunction::linear({knot(0, {1, 1, 1}, 0), knot(1, {1, 1, 1}, 1e-12)});
    names = omitted_in(volume, scene, capabilities());
    EXPECT_FALSE(has(names, "drawing"));
    EXPECT_FALSE(has(names, "volume_texture"));
    const Image image = render(volume, scene, capabilities());
    EXPECT_GT(*std::max_element(image.rgba.begin(), image.rgba.end()), 0);
}

}  // namespace
}  // namespace lamina
