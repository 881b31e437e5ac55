// SPDX-License-Identifier: Apache-2.0
// The choices of targets and trees depend on light, which makes colours brighter.
#include "plan/plan.h"
#include "support/expect_error.h"
#include "support/scene_fixture.h"

namespace lamina {
namespace {

Capabilities native() {
    Capabilities capabilities;
    capabilities.renderer = "test";
    capabilities.cpu = true;
    capabilities.max_texture_size = capabilities.max_3d_texture_size = 16384;
    return capabilities;
}

// Returns the minimal scene, in white, with 40 slabs; light makes a colour at most .8 + .2 + .2 *
// 1.
nlohmann::json lit(const nlohmann::json& target, const nlohmann::json& tree) {
    nlohmann::json document = with("/lighting", {{"smallest_gradient", 1}});
    document["render"] = {{"target", target},
                          {"slice", {{"samples", 40}, {"classification", "post"}}}};
    if (!tree.is_null()) document["render"]["slice"]["tree"] = tree;
    return document;
}

Plan planned_lit(const nlohmann::json& document) {
    const Scene scene = read_scene(document, "scene.json");
    const Volume volume = load_volume(scene);
    return make_plan(scene, measure(scene, volume, measure_bricks(volume)), native(), {});
}

// Fixed-point targets hold only colours up to 1, which a highlight exceeds.
TEST(LitPlan, AutomaticTargetsHoldWhatLightAdds) {
    for (const nlohmann::json& tree : {nlohmann::json(), nlohmann::json("auto")}) {
        nlohmann::json document = lit("auto", tree);
        EXPECT_FALSE(is_fixed_point(planned_lit(document).slice.target));
        document["lighting"]["specular"] = 0;
        EXPECT_TRUE(is_fixed_point(planned_lit(document).slice.target));
    }
}

TEST(LitPlan, AutomaticTreesSayWhatTheTargetClamps) {
    nlohmann::json document = lit("fixed16", "auto");
    expect_error([&] { planned_lit(document); }, {"clamps colours", "float16"});
    document["lighting"]["specular"] = 0;
    EXPECT_NO_THROW(planned_lit(document));
}

// A scene of one colour is refused, too: even a headlight makes many colours of it.
TEST(LitPlan, FixedNodesAreRefusedBecauseOfLight) {
    const nlohmann::json document = lit("fixed8", {{"factors", {8, 5}}, {"nodes", "fixed"}});
    expect_error([&] { planned_lit(document); },
                 {"render.slice.tree.nodes", "\"fixed\"", "expected no lighting", "\"shader\""});
}

}  // namespace
}  // namespace lamina
