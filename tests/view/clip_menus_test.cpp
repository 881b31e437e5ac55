// SPDX-License-Identifier: Apache-2.0
#include "panels/clip_menus.h"

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include "lamina/scene.h"
#include "lamina/session.h"
#include "view/headless_imgui.h"

namespace lamina::view {
namespace {

const Grid::Bounds box_of_data{glm::dvec3(0), glm::dvec3(1)};

Scene scene_to_cut() {
    return parse_scene(R"({"version": 1,
                           "volume": {"generate": "gaussians", "size": [8, 8, 8]},
                           "transfer_function": {"points": [{"value": 0, "extinction": 1}]},
                           "camera": {"eye": [3, 1, 2], "center": [0.5, 0.5, 0.5]},
                           "image": {"width": 4, "height": 3}})",
                       "scene.json");
}

// A menu without its popup, and a hand that clicks and drags.
class ClipMenusTest : public ::testing::Test {
  protected:
    void SetUp() override { document.open(scene_to_cut()); }

    void frame(bool box) {
        imgui.frame([&] {
            if (box)
                menus.draw_crop(document, box_of_data);
            else
                menus.draw_clip(document, box_of_data);
        });
    }
    // Clicks at a place, or drags from there by some pixels to the right.
    void click(bool box, float x, float y, float drag = 0) {
        ImGuiIO& io = ImGui::GetIO();
        io.MousePos = {x, y};
        frame(box);
        io.MouseDown[0] = true;
        frame(box);
        io.MousePos.x += drag;
        frame(box);
        io.MouseDown[0] = false;
        frame(box);
        frame(box);
    }
    // Returns the words that clicks all over the menu ask for.
    std::vector<Words> all_words(bool box) {
        std::vector<Words> found;
        for (float y = 4; y < 120; y += 6) {
            for (float x = 10; x < 480; x += 24) {
                click(box, x, y);
                if (!document.words()) continue;
                found.push_back(*document.words());
                document.undo();
                document.open(scene_to_cut());
            }
        }
        return found;
    }

    test::HeadlessImGui imgui;
    ClipMenus menus;
    Document document;
};

TEST_F(ClipMenusTest, ButtonsClipInTheWordsOfTheCommandLine) {
    std::set<std::string> clips;
    for (const Words& words : all_words(false)) {
        ASSERT_EQ(words.clip.size(), 1u);
        EXPECT_TRUE(words.crop.empty());
        clips.insert(words.clip[0].substr(0, 2));
        Session session(scene_to_cut());
        session.adjust(words);  // throws for words that are none
        EXPECT_EQ(session.scene().clip.planes.size(), 1u);
    }
    EXPECT_EQ(clips, (std::set<std::string>{"x>", "x<", "y>", "y<", "z>", "z<"}));
}

TEST_F(ClipMenusTest, SlidersCropInTheWordsOfTheCommandLine) {
    const std::vector<Words> all = all_words(true);
    ASSERT_FALSE(all.empty());
    for (const Words& words : all) {
        EXPECT_TRUE(words.clip.empty());
        Session session(scene_to_cut());
        session.adjust(words);
        const auto& box = session.scene().clip.box;
        ASSERT_TRUE(box) << words.crop;
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_GE(box->min[axis], box_of_data.min[axis]);
            EXPECT_LE(box->max[axis], box_of_data.max[axis]);
        }
    }
}

// A second plane on a side takes the place of the first, and one step of Undo brings it back.
TEST_F(ClipMenusTest, APlaneTakesThePlaceOfTheOneBefore) {
    document.set_clip({{{{0.25, 0, 0}, {1, 0, 0}}, {{0, 0.1, 0}, {0, 1, 0}}}, {}});
    document.end_step();
    ASSERT_EQ(document.scene().clip.planes.size(), 2u);
    for (float x = 200; x < 480 && !document.words(); x += 12) click(false, x, 20);
    ASSERT_TRUE(document.words());
    ASSERT_EQ(document.words()->clip[0].substr(0, 2), "x>");
    ASSERT_EQ(document.scene().clip.planes.size(), 1u);
    EXPECT_EQ(document.scene().clip.planes[0].normal, glm::dvec3(0, 1, 0));
    document.undo();
    EXPECT_EQ(document.scene().clip.planes.size(), 2u);
}

}  // namespace
}  // namespace lamina::view
