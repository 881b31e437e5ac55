// SPDX-License-Identifier: Apache-2.0
#include "model/scene_keys.h"

#include <gtest/gtest.h>

#include "lamina/color.h"
#include "lamina/error.h"
#include "lamina/scene.h"

namespace lamina::view {
namespace {

Scene scene() {
    return parse_scene(
        R"({"version": 1, "volume": {"generate": "gaussians"},
            "transfer_function": {"points": [{"value": 10, "extinction": 0.1},
                                             {"value": 200, "color": "tomato", "opacity": 0.7}]},
            "camera": {"eye": [3, 1, 2], "center": [0.5, 0.5, 0.5]},
            "render": {"slice": {"samples": 100, "dither": {}}}})",
        "scene.json");
}

TEST(SceneEdit, ChangesOneKeyAndNoOther) {
    const Scene before = scene();
    const Scene after = with_setting(before, "render.slice.tree", {{"factors", "32x32"}});
    ASSERT_TRUE(after.slice.tree);
    EXPECT_EQ((*after.slice.tree)->factors, (std::vector<int>{32, 32}));
    EXPECT_TRUE(after.transfer_function == before.transfer_function);
    EXPECT_FALSE(after.transfer_function.is_automatic());
    EXPECT_EQ(scene_text(with_setting(after, "render.slice.tree", nullptr)), scene_text(before));
    EXPECT_EQ(after.file, before.file);
}

TEST(SceneEdit, ReachesListsAndCreatesMissingGroups) {
    Scene edited = with_setting(scene(), "clip.planes",
                                {{{"point", {1, 2, 3}}, {"normal", {0, 0, 1}}},
                                 {{"point", {4, 5, 6}}, {"normal", {0, 1, 0}}}});
    edited = with_setting(edited, "clip.planes.1.normal", {1, 0, 0});
    ASSERT_EQ(edited.clip.planes.size(), 2u);
    EXPECT_EQ(edited.clip.planes[1].normal, glm::dvec3(1, 0, 0));
    edited = with_setting(edited, "clip.planes.0", nullptr);
    ASSERT_EQ(edited.clip.planes.size(), 1u);
    EXPECT_EQ(edited.clip.planes[0].point, glm::dvec3(4, 5, 6));
    EXPECT_FALSE(with_setting(edited, "clip", nullptr).clip.box);
    EXPECT_TRUE(with_setting(edited, "lighting.ambient", .3).lighting);
    EXPECT_EQ(setting_at(settings_of(edited), "clip.planes.0.point.2"), 6);
    EXPECT_TRUE(setting_at(settings_of(edited), "lighting.ambient").is_null());
}

TEST(SceneEdit, NamesMistakes) {
    const Scene before = scene();
    const auto message = [&](const std::string& path, const nlohmann::ordered_json& value) {
        try {
            with_setting(before, path, value);
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_NE(message("render.method", "project").find("without a mesh"), std::string::npos);
    EXPECT_NE(message("render.slice.samples", 0).find("render.slice.samples"), std::string::npos);
    EXPECT_NE(message("camera.fov_y", 180).find("camera.fov_y"), std::string::npos);
    EXPECT_NE(message("clip.planes.7.point", {1, 2, 3}), "");
    EXPECT_NE(message("render.slice.tree.factors", "32y"), "");
}

TEST(SceneEdit, KeepsTheLookOfColorsInAnotherSpace) {
    Scene before = scene();
    before.background = {.2, .5, 1};
    const Scene after = with_setting(before, "image.color_space", "display");
    EXPECT_EQ(after.background, display_of_color(before.background));
    // Components above 1 have no display value, so they stay.
    EXPECT_EQ(converted_color({.5, 0, 7}, ImageColorSpace::display, ImageColorSpace::linear).z, 7);
}

}  // namespace
}  // namespace lamina::view
