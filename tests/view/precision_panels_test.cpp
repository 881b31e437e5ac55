// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "lamina/scene.h"
#include "model/frame_history.h"
#include "panels/picture_panels.h"
#include "panels/precision_panels.h"
#include "view/headless_imgui.h"

namespace lamina::view {
namespace {

Scene panel_scene() {
    return parse_scene(R"({"version": 1, "volume": {"generate": "gaussians"},
                           "transfer_function": {"points": [{"value": 0, "extinction": 1}]},
                           "camera": {"eye": [3, 1, 2], "center": [0.5, 0.5, 0.5]},
                           "image": {"width": 4, "height": 3},
                           "render": {"target": "fixed8", "slice": {"samples": 64}}})",
                       "scene.json");
}

Shown shown_of(const Document& document) {
    Shown shown;
    shown.kind = PictureKind::full;
    shown.full = std::make_shared<const Image>(Image(4, 3));
    shown.full_screen = shown.screen = std::make_shared<const ScreenPicture>();
    shown.resolved = std::make_shared<const Scene>(document.scene());
    shown.full_revisions = shown.revisions = document.revisions();
    shown.statistics.draw_ms = shown.frame_statistics.draw_ms = 12;
    shown.frame_statistics.stages_ms = {{"draw", 10}};
    ++shown.frame;
    return shown;
}

// Drawing panels changes no document, in any state of the comparison.
TEST(PrecisionPanels, AreDrawnAndChangeNothing) {
    test::HeadlessImGui imgui;
    ErrorPanel error;
    ComparisonPanel comparison;
    FactorsPanel factors;
    AttemptsPanel attempts;
    FramesPanel frames;
    const std::vector<Panel*> panels = {&error, &comparison, &factors, &attempts, &frames};
    Document document;
    PrecisionInSight precision;
    Shown shown;
    const auto draw = [&](PrecisionInSight* known) {
        PanelContext context{document, shown, {}, known};
        for (Panel* const panel : panels) imgui.frame([&] { panel->draw(context); });
    };
    draw(&precision);  // no document is open
    document.open(panel_scene());
    document.size_follows_window = false;
    draw(nullptr);
    shown = shown_of(document);
    precision.follow(document, shown);
    draw(&precision);
    precision.pin(document, shown);
    shown.share_traced = .5;
    shown.error = {1, 0, .5};
    shown.missed = std::make_shared<const PictureDifference>(
        PictureDifference{4, 3, std::vector<float>(12, .5f)});
    for (const CompareWith with : {CompareWith::pinned, CompareWith::truth})
        for (const CompareBy by : {CompareBy::nothing, CompareBy::flip, CompareBy::wipe,
                                   CompareBy::side_by_side, CompareBy::difference}) {
            precision.comparison.with = with;
            precision.comparison.by = by;
            precision.follow(document, shown);
            draw(&precision);
        }
    EXPECT_FALSE(document.can_undo());
    EXPECT_FALSE(document.dirty());
    EXPECT_EQ(precision.attempts.rows().size(), 1u);
    EXPECT_EQ(precision.attempts.rows()[0].share_measured, .5);
}

// Finds a row of the panel by clicking down the window's middle until a click changes the document.
TEST(PrecisionPanels, AClickOnARowRestoresItsScene) {
    test::HeadlessImGui imgui;
    AttemptsPanel panel;
    Document document;
    document.open(panel_scene());
    document.size_follows_window = false;
    PrecisionInSight precision;
    Shown shown = shown_of(document);
    precision.follow(document, shown);
    document.edit([](Scene& scene) { scene.target = Target::float32; });
    document.end_step();
    shown = shown_of(document);
    precision.follow(document, shown);
    ASSERT_EQ(precision.attempts.rows().size(), 2u);
    PanelContext context{document, shown, {}, &precision};
    const auto frame = [&] { imgui.frame([&] { panel.draw(context); }); };
    ImGuiIO& io = ImGui::GetIO();
    frame();
    for (float y = 0; y < 300 && document.scene().target == Target::float32; y += 3) {
        io.MousePos = {30, y};
        frame();
        // Above 40 pixels: the file's name and buttons.
        if (ImGui::IsAnyItemActive() || y < 40) continue;
        io.MouseDown[0] = true;
        frame();
        io.MouseDown[0] = false;
        frame();
    }
    EXPECT_EQ(document.scene().target, Target::fixed8);
    document.undo();
    EXPECT_EQ(document.scene().target, Target::float32);
}

}  // namespace
}  // namespace lamina::view
