// SPDX-License-Identifier: Apache-2.0
#include "model/scene_keys.h"

#include <gtest/gtest.h>

#include "lamina/scene.h"
#include "lamina/session.h"

namespace lamina::view {
namespace {

Scene scene_with(const std::string& render) {
    return parse_scene(R"({"version": 1, "volume": {"generate": "gaussians", "size": [12, 12, 12]},
                           "mesh": {"kuhn": true}, "image": {"width": 24, "height": 18},
                           "render": )" +
                           render + "}",
                       "scene");
}

TEST(KeyEffects, ReasonsFollowTheScene) {
    const Scene slicing = scene_with("{}");
    EXPECT_EQ(why_without_effect(slicing, "render.slice.samples"), "");
    EXPECT_NE(why_without_effect(slicing, "render.project.coloring"), "");
    EXPECT_NE(why_without_effect(slicing, "render.emulate.bits"), "");
    EXPECT_NE(why_without_effect(slicing, "render.slice.dither.seed"), "");
    EXPECT_NE(why_without_effect(slicing, "mesh.tolerance"), "");
    // The camera is automatic: it has no eye yet.
    EXPECT_NE(why_without_effect(slicing, "camera.eye"), "");
    EXPECT_EQ(why_without_effect(slicing, "camera"), "");
    const Scene emulated =
        scene_with(R"({"target": "emulated", "slice": {"dither": {}, "samples": 9}})");
    EXPECT_EQ(why_without_effect(emulated, "render.emulate.bits"), "");
    EXPECT_NE(why_without_effect(emulated, "render.emulate.seed"), "");
    EXPECT_EQ(why_without_effect(emulated, "render.slice.dither.seed"), "");
    EXPECT_EQ(why_without_effect(emulated, "render.trace.of"), "");
}

TEST(KeyEffects, KeysWithoutEffectLeaveThePicture) {
    const SessionOptions native{ContextChoice::cpu, 0, true};
    struct Change {
        const char *render, *path;
        nlohmann::ordered_json value;
    };
    const Change changes[] = {
        {"{}", "render.emulate.bits", 3},
        {"{}", "render.slice.dither", {{"seed", 5}}},
        {R"({"slice": {"classification": "exact"}})", "render.slice.table", {{"scalar", 2}}},
        {R"({"target": "fixed8", "slice": {"samples": 20, "tree":
             {"factors": [20], "nodes": "shader"}}})",
         "render.slice.dither",
         {{"seed", 5}}},
        {R"({"target": "emulated", "slice": {"samples": 20}})", "render.emulate.seed", 77},
        {R"({"method": "project"})", "render.slice.samples", 3},
        {R"({"method": "project"})", "render.project.dither", "alpha"},
        {R"({"method": "project", "project": {"coloring": "analytic"}})",
         "render.project.table",
         {{"scalar", 2}}},
        {R"({"method": "project"})", "mesh.tolerance", .5}};
    for (const Change& change : changes) {
        const Scene before = scene_with(change.render);
        ASSERT_NE(why_without_effect(before, change.path), "") << change.path;
        const Scene after = with_setting(before, change.path, change.value);
        Session first(before, native), second(after, native);
        EXPECT_EQ(first.draw().rgba, second.draw().rgba) << change.path;
    }
}

TEST(KeyEffects, AreKnownForEveryKey) {
    const Scene scene = scene_with("{}");
    for (const std::string& path : paths_below(scene_keys()))
        EXPECT_NO_THROW(why_without_effect(scene, path)) << path;
}

}  // namespace
}  // namespace lamina::view
