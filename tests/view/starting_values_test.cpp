// SPDX-License-Identifier: Apache-2.0
#include "model/viewer_settings.h"

#include <gtest/gtest.h>

#include "lamina/scene.h"
#include "model/scene_keys.h"

namespace lamina::view {
namespace {

Scene started_scene(const std::string& more = "") {
    return parse_scene(R"({"version": 1, "volume": {"generate": "gaussians"}, "mesh": {}, "camera":
                           {"eye": [3, 1, 2], "center": [0.5, 0.5, 0.5]})" +
                           more + "}",
                       "scene");
}

TEST(StartingValues, AreValidInAScene) {
    const Grid::Bounds bounds{glm::dvec3(0), glm::dvec3(1)};
    const Scene scene = started_scene();
    const auto look = [&](const auto& again, const SettingNode& node) -> void {
        for (const SettingNode& part : node.parts) {
            if (may_be_absent(part)) {
                const Scene with = with_setting(
                    scene, part.path, starting_value(part, part.path, scene, nullptr, bounds));
                const auto started = setting_at(settings_of(with), part.path);
                // An annotation without settings of its own is written as true.
                EXPECT_TRUE(started.is_object() || started == true || started == "Text")
                    << part.path;
            }
            again(again, part);
        }
    };
    look(look, scene_keys());
    const SettingNode& plane = scene_key("clip.planes[]");
    EXPECT_EQ(with_setting(scene, "clip.planes",
                           nlohmann::ordered_json::array(
                               {starting_value(plane, "clip.planes.0", scene, nullptr, bounds)}))
                  .clip.planes.size(),
              1u);
}

TEST(StartingValues, AreWhatWasChosenForAutomaticKeys) {
    const Scene scene = started_scene();
    Scene resolved = scene;
    resolved.slice.samples = 321;
    const SettingNode& samples = scene_key("render.slice.samples");
    EXPECT_EQ(starting_value(samples, samples.path, scene, &resolved, {}), 321);
    EXPECT_EQ(starting_value(samples, samples.path, scene, nullptr, {}), 1);
    const SettingNode& direction = scene_key("lighting.lights[].direction");
    EXPECT_EQ(starting_value(direction, "lighting.lights.0.direction", scene, nullptr, {}),
              (nlohmann::ordered_json{0, 0, 1}));
}

// A group that may be absent is not in the file of a scene without it.
TEST(StartingValues, GroupsThatMayBeAbsentAreNotWritten) {
    const nlohmann::ordered_json plain =
        settings_of(parse_scene(R"({"version": 1, "volume": {"generate": "ramp"}})", "scene"));
    const auto look = [&](const auto& again, const SettingNode& node) -> void {
        for (const SettingNode& part : node.parts) {
            if (part.kind == SettingKind::group && part.path != "clip" &&
                part.path != "transfer_function" && !part.path.ends_with("[]")) {
                const bool there = !setting_at(plain, part.path).is_null();
                EXPECT_NE(may_be_absent(part), there) << part.path;
                if (!there) continue;
            }
            again(again, part);
        }
    };
    look(look, scene_keys());
}

}  // namespace
}  // namespace lamina::view
