// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "lamina/scene.h"
#include "panels/help_window.h"
#include "panels/panel.h"
#include "view/headless_imgui.h"

namespace lamina::view {
namespace {

void draw_all(Document& document, const Shown& shown) {
    test::HeadlessImGui imgui;
    const auto panels = make_panels();
    for (int i = 0; i < 3; ++i) {
        imgui.frame([&] {
            PanelContext context{document, shown, 30};
            for (const auto& panel : panels) {
                ImGui::BeginChild(panel->title(), {480, 600});
                panel->draw(context);
                ImGui::EndChild();
            }
            bool help = true;
            help_window(help);
        });
    }
}

TEST(Panels, DrawWithoutAScene) {
    Document document;
    draw_all(document, Shown());
    document.open(parse_scene(R"({"version": 1, "volume": {"generate": "ramp"}})", "scene"));
    draw_all(document, Shown());
    EXPECT_FALSE(document.can_undo());
}

TEST(Panels, DrawWhatIsShown) {
    Document document;
    document.open(parse_scene(
        R"({"version": 1, "volume": {"generate": "ramp"}, "transfer_function": {"points": [
            {"value": 10, "color": "red", "opacity": 0}, {"value": 90, "opacity": 0.9}]}})",
        "scene"));
    document.transfer().select_only({TransferHandle::Curve::density, 1});
    Shown shown;
    shown.loaded = 1;
    shown.full = std::make_shared<const Image>(4, 3);
    shown.resolved = std::make_shared<const Scene>(document.scene());
    shown.plan.left_out = {{"perspective", "the view is orthographic"}};
    shown.explanation = "slabs: 1\nfilter: exact";
    shown.failure = "found \"x\", expected another";
    ValueHistogram histogram;
    histogram.lo = histogram.least = 0;
    histogram.hi = histogram.most = 255;
    histogram.shares = {.5, 0, .25, .25};
    shown.histogram = std::make_shared<const ValueHistogram>(histogram);
    draw_all(document, shown);
    EXPECT_FALSE(document.can_undo());
}

}  // namespace
}  // namespace lamina::view
