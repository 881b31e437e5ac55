// SPDX-License-Identifier: Apache-2.0
#include "panels/transfer_plot.h"

#include <gtest/gtest.h>

#include <cmath>

#include "view/headless_imgui.h"

namespace lamina::view {
namespace {

using Curve = TransferHandle::Curve;

// A TransferPlot in a window without a screen, with simulated pointer and keys.
class TransferPlotUse : public testing::Test {
  protected:
    TransferPlotUse() {
        imgui_.size = {900, 320};
        editor_.take(TransferFunction::linear({{20, {{1, 0, 0}, 0}, false},
                                               {120, {{0, 1, 0}, .4}, false},
                                               {220, {{0, 0, 1}, 1}, false}}));
        histogram_.lo = histogram_.least = 0;
        histogram_.hi = histogram_.most = 255;
        histogram_.shares = {.5, .25, 0, .25};
        // ImGui gives a new window the pointer from the second frame on.
        frame();
        frame();
    }

    std::string frame() {
        std::string edited;
        imgui_.frame([&] {
            edited = plot_.draw(editor_, {&histogram_, {}, ImageColorSpace::linear},
                                ImGui::GetContentRegionAvail());
        });
        if (!edited.empty()) last_edit_ = edited;
        return edited;
    }

    ImVec2 place_of(std::size_t index) const {
        const DensityPoint& point = editor_.curves().density[index];
        return pixel(plot_.frame().x(point.value), plot_.frame().y(point.extinction));
    }

    // ImGui rounds the pointer down to whole pixels.
    static ImVec2 pixel(float x, float y) { return {std::floor(x), std::floor(y)}; }

    void point_at(const ImVec2& at) {
        ImGui::GetIO().MousePos = at;
        frame();
    }
    void press(int button = 0) {
        ImGui::GetIO().MouseDown[button] = true;
        frame();
    }
    void release(int button = 0) {
        ImGui::GetIO().MouseDown[button] = false;
        frame();
        frame();
    }
    void click(const ImVec2& at) {
        point_at(at);
        press();
        release();
        wait();
    }
    void drag(const ImVec2& from, const ImVec2& to, int button = 0) {
        point_at(from);
        press(button);
        point_at({(from.x + to.x) / 2, (from.y + to.y) / 2});
        point_at(to);
        release(button);
        wait();
    }
    // Draws 40 frames, longer than the time between the clicks of a double click.
    void wait() {
        for (int i = 0; i < 40; ++i) frame();
    }
    void key(ImGuiKey key) {
        ImGui::GetIO().KeysDown[key] = true;
        frame();
        ImGui::GetIO().KeysDown[key] = false;
        frame();
    }

    test::HeadlessImGui imgui_;
    TransferEditor editor_;
    TransferPlot plot_;
    ValueHistogram histogram_;
    std::string last_edit_;
};

TEST_F(TransferPlotUse, ADragMovesAPoint) {
    const ImVec2 from = place_of(1);
    const double value = editor_.curves().density[1].value;
    const DensityPoint last = editor_.curves().density[2];
    drag(from, {from.x + 30, from.y - 20});
    EXPECT_EQ(last_edit_, "move");
    // Screen coordinates below 1024 in float32: 1e-3 pixels bound their rounding.
    EXPECT_NEAR(editor_.curves().density[1].value, value + plot_.frame().values(30),
                plot_.frame().values(1e-3f));
    EXPECT_GT(editor_.curves().density[1].extinction, .4);
    EXPECT_EQ(editor_.curves().density[2], last);
    EXPECT_FALSE(editor_.is_moving());
}

TEST_F(TransferPlotUse, ADoubleClickAddsAPoint) {
    const ImVec2 at = pixel(plot_.frame().x(60), plot_.frame().y(.7));
    point_at(at);
    for (int i = 0; i < 2; ++i) {
        press();
        release();
    }
    EXPECT_EQ(last_edit_, "new point");
    ASSERT_EQ(editor_.curves().density.size(), 4u);
    EXPECT_NEAR(editor_.curves().density[1].value, 60, plot_.frame().values(1));
    EXPECT_EQ(editor_.curves().density[1].value, plot_.frame().value(at.x));
    wait();
    key(ImGuiKey_Delete);
    EXPECT_EQ(last_edit_, "delete");
    EXPECT_EQ(editor_.curves().density.size(), 3u);
}

TEST_F(TransferPlotUse, ClicksSelectAndArrowKeysMovePoints) {
    click(place_of(1));
    EXPECT_TRUE(editor_.is_selected({Curve::density, 1}));
    const DensityPoint before = editor_.curves().density[1];
    key(ImGuiKey_RightArrow);
    EXPECT_NEAR(editor_.curves().density[1].value, 120 + plot_.frame().values(1), 1e-9);
    EXPECT_EQ(editor_.curves().density[1].extinction, before.extinction);
    key(ImGuiKey_UpArrow);
    EXPECT_GT(editor_.curves().density[1].extinction, before.extinction);
    ImGui::GetIO().KeyShift = true;
    click(place_of(2));
    ImGui::GetIO().KeyShift = false;
    EXPECT_EQ(editor_.selection().size(), 2u);
    // Selects the first two points with a rectangle.
    click({plot_.frame().min.x + 5, plot_.frame().min.y + 5});
    EXPECT_TRUE(editor_.selection().empty());
    const ImVec2 corner = place_of(1);
    drag({plot_.frame().min.x + 1, corner.y - 15}, {corner.x + 15, plot_.frame().max.y + 2});
    EXPECT_EQ(editor_.selection().size(), 2u);
    EXPECT_FALSE(editor_.is_selected({Curve::density, 2}));
}

TEST_F(TransferPlotUse, TheRightButtonChangesWindowAndLevel) {
    const ImVec2 empty(plot_.frame().min.x + 5, plot_.frame().min.y + 5);
    drag(empty, {empty.x + 40, empty.y}, 1);
    EXPECT_EQ(last_edit_, "window and level");
    const double shift = plot_.frame().values(40);
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_NEAR(editor_.curves().density[i].value, 20 + 100. * static_cast<double>(i) + shift,
                    1e-3);
    drag(empty, {empty.x, empty.y + 50}, 1);
    const auto& density = editor_.curves().density;
    EXPECT_LT(density[2].value - density[0].value, 180);
    EXPECT_NEAR(density[1].value, 120 + shift, 1e-3);
}

TEST_F(TransferPlotUse, EscapeTakesADragBack) {
    const TransferCurves before = editor_.curves();
    const ImVec2 from = place_of(1);
    point_at(from);
    press();
    point_at({from.x + 50, from.y});
    EXPECT_FALSE(editor_.curves() == before);
    key(ImGuiKey_Escape);
    EXPECT_TRUE(editor_.curves() == before);
    release();
    EXPECT_TRUE(editor_.curves() == before);
}

TEST_F(TransferPlotUse, TheWheelShowsFewerValuesAroundThePointer) {
    const ImVec2 at(plot_.frame().x(150), plot_.frame().y(.1));
    point_at(at);
    ImGui::GetIO().MouseWheel = 2;
    frame();
    EXPECT_LT(plot_.frame().value_hi - plot_.frame().value_lo, 200);
    EXPECT_NEAR(plot_.frame().value(at.x), 150, .1);
}

}  // namespace
}  // namespace lamina::view
