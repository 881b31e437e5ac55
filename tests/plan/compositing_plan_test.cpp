// SPDX-License-Identifier: Apache-2.0
// How a plan composites: emulated targets, dithering, trees.
#include "plan/plan.h"
#include "support/expect_error.h"
#include "support/scene_fixture.h"

namespace lamina {
namespace {

Capabilities usual() {
    Capabilities capabilities;
    capabilities.renderer = "test";
    capabilities.max_texture_size = 16384;
    capabilities.max_3d_texture_size = 2048;
    return capabilities;
}

// Returns the minimal scene, of one colour, with 40 slabs and this "render".
nlohmann::json scene_with(const nlohmann::json& render) {
    nlohmann::json document = with("/render", render);
    document["render"]["slice"]["samples"] = 40;
    return document;
}

nlohmann::json colored(nlohmann::json document) {
    document["transfer_function"]["points"][0]["color"] = {1, 0, 0};
    return document;
}

nlohmann::json rendered(const char* target, const nlohmann::json& slice) {
    return scene_with({{"target", target}, {"slice", slice}});
}

struct Planned {
    Plan plan;
    Facts facts;
};

Planned planned(const nlohmann::json& document, const Capabilities& capabilities = usual()) {
    const Scene scene = read_scene(document, "scene.json");
    const Volume volume = load_volume(scene);
    const Facts facts = measure(scene, volume, measure_bricks(volume));
    return {make_plan(scene, facts, capabilities, {}), facts};
}

SlicePlan slice_of(const nlohmann::json& document, const Capabilities& capabilities = usual()) {
    return planned(document, capabilities).plan.slice;
}

std::string explained(const nlohmann::json& document) {
    const Planned found = planned(document);
    return explain(found.plan, found.facts, usual());
}

void expect_parts(const std::string& text, std::initializer_list<const char*> parts) {
    for (const char* part : parts) EXPECT_NE(text.find(part), std::string::npos) << part << text;
}

TEST(CompositingPlan, EmulatedTargetsAreComposedInRegisters) {
    nlohmann::json document =
        scene_with({{"target", "emulated"}, {"emulate", {{"bits", 12}, {"over", "fused"}}}});
    Capabilities capabilities = usual();
    SlicePlan slice = slice_of(document, capabilities);
    EXPECT_EQ(slice.blending, Blending::registers);
    ASSERT_TRUE(slice.emulation.has_value());
    EXPECT_EQ(slice.emulation->over, OverRounding::fused);
    EXPECT_EQ(slice.code_bits(), 12);
    document["render"]["slice"]["tree"] = {{"factors", "4"}, {"nodes", "fixed"}};
    EXPECT_EQ(slice_of(document, capabilities).blending, Blending::registers);
    capabilities.cpu = true;
    EXPECT_EQ(slice_of(document, capabilities).blending, Blending::tiles);
    // The blending unit composites other targets.
    slice = slice_of(scene_with({{"target", "fixed8"}}), capabilities);
    EXPECT_EQ(slice.blending, Blending::native);
    EXPECT_FALSE(slice.emulation.has_value());
}

bool omits_dither(const Plan& plan) {
    return std::ranges::any_of(plan.omitted,
                               [](const Omission& other) { return other.name == "dither"; });
}

TEST(CompositingPlan, DitherNeedsCodes) {
    const nlohmann::json dither = {{"period", 4}, {"seed", 9}, {"color", true}, {"increment", 2}};
    const nlohmann::json fixed_tree = {{"factors", 8}, {"nodes", "fixed"}};
    for (const char* target : {"float32", "float16", "fixed16", "fixed8", "emulated"}) {
        const bool is_float = std::string(target).starts_with("float");
        const Plan straight = planned(rendered(target, {{"dither", dither}})).plan;
        EXPECT_EQ(straight.slice.dither.has_value(), !is_float) << target;
        EXPECT_EQ(omits_dither(straight), is_float) << target;
        if (is_float) continue;
        EXPECT_EQ(straight.slice.dither->period, 4);
        EXPECT_EQ(straight.slice.dither->seed, 9u);
        EXPECT_TRUE(straight.slice.dither->color);
        EXPECT_EQ(straight.slice.dither->increment, 2);
        const Plan fixed =
            planned(rendered(target, {{"dither", dither}, {"tree", fixed_tree}})).plan;
        EXPECT_TRUE(fixed.slice.dither.has_value() && !omits_dither(fixed)) << target;
    }
    for (const nlohmann::json& tree : {nlohmann::json("auto"), nlohmann::json{{"factors", 8}}}) {
        const Plan plan = planned(rendered("fixed8", {{"dither", dither}, {"tree", tree}})).plan;
        EXPECT_TRUE(plan.slice.has_tree(NodeArithmetic::shader));
        EXPECT_TRUE(!plan.slice.dither && omits_dither(plan));
    }
    EXPECT_FALSE(omits_dither(planned(rendered("float32", {})).plan));  // nobody asked for it
}

TEST(CompositingPlan, AutomaticPeriodIsTheNumberOfSlabs) {
    EXPECT_EQ(slice_of(rendered("fixed8", {{"dither", {{"period", "auto"}}}})).dither->period, 40);
}

TEST(CompositingPlan, FixedNodesNeedFixedPointAndOneColor) {
    const nlohmann::json tree = {{"tree", {{"factors", {8, 5}}, {"nodes", "fixed"}}}};
    for (const char* target : {"fixed8", "fixed16", "emulated"}) {
        EXPECT_TRUE(slice_of(rendered(target, tree)).has_tree(NodeArithmetic::fixed));
        expect_error([&] { planned(colored(rendered(target, tree))); },
                     {"scene.json: render.slice.tree.nodes", "\"fixed\"", "several colours",
                      "expected one colour"});
    }
    for (const char* target : {"float32", "float16"}) {
        expect_error([&] { planned(rendered(target, tree)); },
                     {"scene.json: render.slice.tree.nodes", "\"fixed\"", target,
                      "expected target fixed8, fixed16 or emulated"});
    }
}

TEST(CompositingPlan, ShaderNodesTakeAnyColorButNoEmulatedTarget) {
    const nlohmann::json tree = {
        {"tree", {{"factors", "8x5"}, {"code", "alpha"}, {"alpha_bits", 16}}}};
    for (const char* target : {"fixed8", "fixed16", "float16", "float32"}) {
        const SlicePlan slice = slice_of(colored(rendered(target, tree)));
        ASSERT_TRUE(slice.has_tree(NodeArithmetic::shader)) << target;
        EXPECT_EQ(slice.tree->factors, (std::vector<int>{8, 5}));
        EXPECT_EQ(slice.tree->code, NodeCode::alpha);
        EXPECT_EQ(slice.tree->alpha_bits, 16);
    }
    expect_error([&] { planned(rendered("emulated", tree)); },
                 {"scene.json: render.slice.tree.nodes", "\"shader\"", "\"emulated\"",
                  "expected \"fixed\""});
}

TEST(CompositingPlan, AutomaticTreesKeepToMaxError) {
    nlohmann::json document = rendered("fixed8", {{"tree", "auto"}});
    const SlicePlan slice = slice_of(document);
    ASSERT_TRUE(slice.tree.has_value());
    EXPECT_EQ(slice.tree->factors, (std::vector<int>{40}));
    EXPECT_LE(slice.error_bound.value(), 1);
    document["render"]["max_error"] = 0.1;  // one rounding to 8 bits is up to 0.5
    expect_error([&] { planned(document); }, {"scene.json: render.max_error: 0.1 cannot be kept",
                                              "fixed8", "0.5", "max_error"});
    document["render"]["target"] = "fixed16";
    EXPECT_LE(slice_of(document).error_bound.value(), 0.1);
}

// A node of an automatic tree may have more slabs than a driver's loops can march: several
// dispatches draw it.
TEST(CompositingPlan, AutomaticTreesMayHaveNodesOfManySlabs) {
    nlohmann::json document = rendered("fixed16", {{"tree", "auto"}});
    document["render"]["slice"]["samples"] = 65536;
    document["render"]["slice"]["classification"] = "post";
    document["render"]["max_error"] = 4;
    const SlicePlan plan = slice_of(document);
    EXPECT_EQ(plan.tree.value().factors, std::vector{65536});
    EXPECT_LT(plan.marched_slabs, 65536);
}

// The bound counts only slabs that show. Slabs that lie in several textures are composited in
// several draws and count for each.
TEST(CompositingPlan, AutomaticTreesCountVisibleSlabs) {
    nlohmann::json document = rendered("float16", {{"tree", "auto"}});
    const double all = slice_of(document).error_bound.value();
    Capabilities small = usual();
    small.max_3d_texture_size = 6;
    const SlicePlan cut = slice_of(document, small);
    EXPECT_GT(cut.bricks.size(), 1u);
    EXPECT_GT(cut.error_bound.value(), all);
    document["transfer_function"]["points"][1]["opacity"] = 0;
    EXPECT_LT(slice_of(document).error_bound.value(), all);
    for (nlohmann::json& point : document["transfer_function"]["points"])
        point["color"] = {2, 1, 1};
    document["transfer_function"]["points"][1]["opacity"] = 0.5;
    EXPECT_NEAR(slice_of(document).error_bound.value(), 2 * all, 1e-9);
}

TEST(CompositingPlan, ExplainSaysHowSlabsAreComposited) {
    expect_parts(explained(scene_with({{"target", "emulated"},
                                       {"emulate", {{"bits", 12}, {"alpha", "nearest"}}},
                                       {"slice",
                                        {{"dither", {{"period", "auto"}, {"increment", 3}}},
                                         {"tree", {{"factors", {4, 4}}, {"nodes", "fixed"}}}}}})),
                 {"12 bits, alpha nearest, over separate", "registers", "in front of the eye",
                  "slab opacity", "period 40, seed 1, increment 3", "4x4x3, nodes fixed"});
    expect_parts(explained(rendered("fixed8", {{"dither", nlohmann::json::object()},
                                               {"tree", {{"factors", "8x5"}, {"code", "phi"}}}})),
                 {"8x5, nodes shader, code phi, alpha 8 bits", "dither", "nothing to dither"});
    expect_parts(explained(rendered("fixed8", {{"tree", "auto"}})),
                 {"40, nodes shader, code minimax", "at most 0.5", "one node of 40 slabs"});
}

}  // namespace
}  // namespace lamina
