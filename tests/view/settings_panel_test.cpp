// SPDX-License-Identifier: Apache-2.0
#include "panels/settings_panel.h"

#include <gtest/gtest.h>

#include <set>

#include "lamina/scene.h"
#include "model/scene_keys.h"
#include "view/headless_imgui.h"

namespace lamina::view {
namespace {

Document opened(const std::string& scene) {
    Document document;
    document.open(parse_scene(scene, "scene"));
    return document;
}

std::set<std::string> keys() {
    std::set<std::string> paths;
    for (const std::string& path : paths_below(scene_keys()))
        if (!path.ends_with("[]")) paths.insert(path);
    return paths;
}

// The panel draws a control for each of scene_keys(), which scene_keys_test.cpp compares with the
// schema.
TEST(SettingsPanel, HasAControlForEveryKey) {
    Document document = opened(R"({"version": 1, "volume": {"generate": "gaussians"}})");
    const Shown shown;
    PanelContext context{document, shown, {}};
    test::HeadlessImGui imgui;
    SettingsPanel panel;
    panel.all_open = true;
    imgui.frame([&] { panel.draw(context); });
    EXPECT_EQ(panel.drawn(), keys());
    EXPECT_FALSE(document.can_undo());  // drawing changes nothing
}

TEST(SettingsPanel, DrawsScenesOfAllKinds) {
    const Shown shown;
    for (const char* const scene :
         {R"({"version": 1, "volume": {"generate": "gaussians"}, "mesh": {"kuhn": true},
              "clip": {"planes": [{"point": [0, 0, 0], "normal": [1, 0, 0]}],
                       "box": {"min": [0, 0, 0], "max": [1, 1, 1]}},
              "lighting": {"lights": [{"direction": [0, 0, 1], "color": "red"}, {}]},
              "render": {"method": "project", "target": "fixed8",
                         "project": {"tree": {"factors": [4, 4], "nodes": "fixed"},
                                     "table": {"scalar": 64}}}})",
          R"({"version": 1, "mesh": "a.vtu", "scalar": "density"})",
          R"({"version": 1, "volume": "b.nrrd", "camera": {"projection": "orthographic",
              "eye": [0, 0, 1], "center": [0, 0, 0], "height": 2},
              "render": {"target": "emulated", "slice": {"tree": "auto", "dither": {},
                         "table": {}, "samples": 30}}})",
          R"({"version": 1, "volume": {"generate": "ramp"}, "render": {"method": "trace"}})"}) {
        Document document = opened(scene);
        PanelContext context{document, shown, {}};
        test::HeadlessImGui imgui;
        SettingsPanel panel;
        for (const bool all : {false, true, true}) {
            panel.all_open = all;
            imgui.frame([&] { panel.draw(context); });
        }
        EXPECT_EQ(panel.drawn(), keys());
        EXPECT_FALSE(document.can_undo());
    }
}

}  // namespace
}  // namespace lamina::view
