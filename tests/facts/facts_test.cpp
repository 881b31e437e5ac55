// SPDX-License-Identifier: Apache-2.0
#include "facts/volume_facts.h"

#include <cmath>
#include <memory>

#include "reference/fixtures.h"
#include "support/expect_error.h"
#include "support/scene_fixture.h"
#include "support/transfer_functions.h"
#include "support/volume_of.h"

namespace lamina {
namespace {

Facts facts_of(const nlohmann::json& document) {
    const Scene scene = read_scene(document, "s");
    const Volume volume = load_volume(scene);
    return measure(scene, volume, measure_bricks(volume));
}

TEST(Facts, HaveTheDepthsOfTheBoxSeenFromTheEye) {
    nlohmann::json document = minimal_scene();
    document["camera"] = {{"eye", {0.5, 0.5, 3}}, {"center", {0.5, 0.5, 0.5}}};
    Facts facts = facts_of(document);
    EXPECT_DOUBLE_EQ(facts.near_depth, 2);
    EXPECT_DOUBLE_EQ(facts.far_depth, 3);
    EXPECT_NEAR(facts.voxels_along_view, 15, 1e-12);
    EXPECT_FALSE(facts.eye_inside);
    document["camera"]["eye"] = {0.5, 0.5, 0.75};
    facts = facts_of(document);
    EXPECT_TRUE(facts.eye_inside);
    EXPECT_EQ(facts.near_depth, 0);
    EXPECT_DOUBLE_EQ(facts.far_depth, .75);
    document["camera"]["center"] = {0.5, 0.5, 7};
    document["camera"]["eye"] = {0.5, 0.5, 3};
    facts = facts_of(document);
    EXPECT_LE(facts.far_depth, facts.near_depth);
}

TEST(Facts, TransferFunctionIsJudgedOverTheVolumesRangeOnly) {
    nlohmann::json document = minimal_scene();
    document["volume"] = {{"generate", "constant"}, {"size", {8, 8, 8}}};
    document["transfer_function"]["points"] = nlohmann::json::parse(
        R"([{"value": 0, "extinction": 0, "color": [1, 0, 0]}, {"value": 100, "extinction": 1, "color": [0, 1, 0]},
            {"value": 200, "extinction": 1, "color": [0, 1, 0]}])");
    const Facts facts = facts_of(document);  // all samples are 128
    EXPECT_TRUE(facts.constant);
    EXPECT_TRUE(facts.single_color);
    EXPECT_EQ(facts.max_extinction, 1);
    EXPECT_EQ(facts.occupied_share, 1);
    EXPECT_EQ(facts.max_color, 1);
    // Both sides of a step count, also if it lies at an end of the range (255).
    const auto step_at = [&](double value, double before, double behind) {
        auto& points = document["transfer_function"]["points"];
        points[1]["value"] = points[2]["value"] = value;
        points[1]["color"] = {0, before, 0};
        points[2]["color"] = {0, behind, 0};
        return facts_of(document).max_color;
    };
    document["volume"] = {{"generate", "ramp"}};  // 0 .. 255
    for (const double value : {128., 255.}) {
        EXPECT_EQ(step_at(value, 9, 1), 9);
        EXPECT_EQ(step_at(value, 1, 9), 9);
    }
    // The colour at 255, the largest value, is halfway from 0 (at value 0) to 9 (at value 510).
    EXPECT_EQ(step_at(510, 9, 1), 4.5);
}

// The only samples above 0 form the plane x = 16, the common border of bricks 3 and 4 of twelve:
// both bricks are visible.
TEST(Facts, OccupiedBricksAreThoseThatShowSomething) {
    const Volume volume =
        test::volume_of<float>(test::grid_of({49, 17, 33}, Centering::node),
                               [](double i, double, double) { return i == 16 ? 1 : 0; });
    Scene scene = read_scene(minimal_scene(), "s");
    scene.transfer_function =
        TransferFunction::linear({test::knot(.5, {1, 1, 1}, 0), test::knot(1, {1, 1, 1}, 1)});
    const Facts facts = measure(scene, volume, measure_bricks(volume));
    const OccupiedBricks& bricks = facts.occupied_bricks;
    EXPECT_EQ(bricks.count, (std::array<std::int64_t, 3>{12, 4, 8}));
    for (std::int64_t x = 0; x < 12; ++x)
        EXPECT_EQ(bricks.distance_at(x, x % 4, x % 8), x < 4 ? 3 - x : x - 4) << x;
    EXPECT_DOUBLE_EQ(facts.occupied_share, 2. / 12);
    EXPECT_EQ(facts.occupied.min.x, 12);
    EXPECT_EQ(facts.occupied.max.x, 20);
    EXPECT_TRUE(bricks.any_in({19.9, 3, 40}, {70, 3, 40}));
    EXPECT_FALSE(bricks.any_in({20, -2, 0}, {70, 20, 40}));
    EXPECT_TRUE(bricks.any_in({-7, -2, 0}, {12.1, 20, 40}));
}

// A brick whose largest value is exactly where extinction starts to rise counts as empty, unless
// float32 rounding could make it show: steep rises and steps. The box's diagonal is 32.03 long.
TEST(Facts, BricksThatEndWhereSomethingBeginsAreEmpty) {
    const Volume volume =
        test::volume_of<float>(test::grid_of({33, 2, 2}, Centering::node),
                               [](double i, double, double) { return i > 16 ? 1 : .25; });
    Scene scene = read_scene(minimal_scene(), "s");
    const auto share = [&](double value, double extinction) {
        scene.transfer_function = TransferFunction::linear(
            {test::knot(.25, {1, 1, 1}, 0), test::knot(value, {1, 1, 1}, extinction)});
        return measure(scene, volume, measure_bricks(volume)).occupied_share;
    };
    // Rounding may reach .75e-6 (1e-6 of the range .25 .. 1) beyond .25. Along 32.03, extinction
    // that rises by 4 to 5 per unit of the value then adds an optical depth of 1e-4, the limit; the
    // slopes here are 3.6 and 4.8.
    EXPECT_EQ(share(.5, .9), .5);
    EXPECT_EQ(share(.5, 1.2), 1);
    EXPECT_EQ(share(.25, 1e-3), 1);
    EXPECT_EQ(share(.25, 1e-12), 1);
    // If extinction starts to rise at the volume's largest value, nothing shows at all.
    scene.transfer_function =
        TransferFunction::linear({test::knot(1, {1, 1, 1}, 0), test::knot(1.1, {1, 1, 1}, 1e6)});
    EXPECT_EQ(measure(scene, volume, measure_bricks(volume)).occupied_share, 0);
}

// int16 is shifted by 32768, and float32 holds such codes to 32768 * 2^-24 = .002: the value 40 may
// show if extinction rises from 40.004 on, but not from 41 on.
TEST(Facts, KeepAMarginForTheCodesOfIntegers) {
    const auto samples = std::make_shared<std::vector<std::int16_t>>(33 * 2 * 2);
    for (std::size_t i = 0; i < samples->size(); ++i) (*samples)[i] = i % 33 > 16 ? 100 : 40;
    const Volume volume(test::grid_of({33, 2, 2}, Centering::node), SampleType::int16,
                        std::shared_ptr<const void>(samples, samples->data()));
    Scene scene = read_scene(minimal_scene(), "s");
    const auto share_from = [&](double value) {
        scene.transfer_function = TransferFunction::linear(
            {test::knot(value, {1, 1, 1}, 0), test::knot(100, {1, 1, 1}, 1)});
        return measure(scene, volume, measure_bricks(volume)).occupied_share;
    };
    EXPECT_EQ(share_from(40.004), 1);
    EXPECT_EQ(share_from(41), .5);
}

TEST(Facts, CountNonFiniteSamplesAndRequireANanPolicy) {
    const Grid grid = reference_test::make_grid({3, 3, 3}, Centering::node);
    std::vector<float> samples(27, .5f);
    samples[13] = NAN;
    samples[0] = INFINITY;
    const Volume volume = reference_test::make_volume(grid, samples);
    Scene scene = read_scene(minimal_scene(), "s");
    expect_error([&] { measure(scene, volume, measure_bricks(volume)); },
                 {"2 NaN", "of 27", "transparent"});
    scene.nan = NanPolicy::transparent;
    EXPECT_EQ(measure(scene, volume, measure_bricks(volume)).non_finite, 2);
    const Volume nothing = reference_test::make_volume(grid, std::vector<float>(27, NAN));
    expect_error([&] { measure(scene, nothing, measure_bricks(nothing)); }, {"all 27"});
}

}  // namespace
}  // namespace lamina
