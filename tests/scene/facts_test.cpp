// SPDX-License-Identifier: Apache-2.0
#include "scene/facts.h"

#include <cmath>

#include "reference/fixtures.h"
#include "scene_fixture.h"
#include "support/expect_error.h"

namespace lamina {
namespace {

Facts facts_of(const nlohmann::json& document) {
    const Scene scene = read_scene(document, "s");
    const Volume volume = load_volume(scene);
    return measure(scene, volume, measure_bricks(volume));
}

TEST(Facts, DepthsOfTheUnitBox) {
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
}

TEST(Facts, NonFiniteSamplesAreCountedAndNeedAWord) {
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
