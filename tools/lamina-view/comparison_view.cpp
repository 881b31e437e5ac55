// SPDX-License-Identifier: Apache-2.0
#include "comparison_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "lamina/image.h"
#include "panels/theme.h"

namespace lamina::view {

// GL_LINEAR has no effect if each pixel of the picture covers one pixel of the screen.
PictureTexture::PictureTexture(const GladGLContext& gl) : gl_(gl) {
    gl_.GenTextures(1, &name_);
    gl_.BindTexture(GL_TEXTURE_2D, name_);
    gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
}

PictureTexture::~PictureTexture() {
    gl_.DeleteTextures(1, &name_);
}

void PictureTexture::show(const ScreenPicture& picture) {
    gl_.BindTexture(GL_TEXTURE_2D, name_);
    gl_.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    if (picture.width == width_ && picture.height == height_) {
        gl_.TexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width_, height_, GL_RGB, GL_UNSIGNED_BYTE,
                          picture.rgb.data());
        return;
    }
    width_ = picture.width;
    height_ = picture.height;
    gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, width_, height_, 0, GL_RGB, GL_UNSIGNED_BYTE,
                   picture.rgb.data());
}

namespace {

constexpr ImU32 label_back = IM_COL32(16, 17, 19, 200), white = IM_COL32(255, 255, 255, 255);

ImDrawList& background() {
    return *ImGui::GetBackgroundDrawList();
}

// Draws a label on a dark ground between `min` and `max`.
void draw_label(const std::string& text, const ImVec2& min, const ImVec2& max, bool right) {
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    const float gap = em(.5f);
    const float left = right ? std::max(max.x - size.x - 2 * gap, min.x) : min.x;
    ImDrawList& list = background();
    list.PushClipRect(min, max, true);
    list.AddRectFilled({left, min.y}, {left + size.x + 2 * gap, min.y + size.y + gap}, label_back);
    list.AddText({left + gap, min.y + gap / 2}, white, text.c_str());
    list.PopClipRect();
}

ImU32 color_of_share(double share) {
    const std::array<float, 1> e = {static_cast<float>(share)};
    const std::vector<std::uint8_t> codes = difference_codes(e, 1);
    return IM_COL32(codes[0], codes[1], codes[2], 255);
}

}  // namespace

ComparisonView::ComparisonView(const GladGLContext& gl) : other_(gl), edited_(gl), colors_(gl) {}

void ComparisonView::Slot::take(const std::shared_ptr<const ScreenPicture>& picture) {
    if (!picture || picture == shown) return;
    texture.show(*picture);
    shown = picture;
}

ImTextureID ComparisonView::Slot::id() const {
    return reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(texture.name()));
}

void ComparisonView::draw(Comparison& comparison, const PictureArea& area, const std::string& a,
                          const std::string& b) {
    if (!comparison.active()) return;
    min_ = {static_cast<float>(area.corner.x), static_cast<float>(area.corner.y)};
    max_ = {static_cast<float>(area.corner.x + area.size.x),
            static_cast<float>(area.corner.y + area.size.y)};
    other_.take(comparison.other());
    edited_.take(comparison.edited());
    switch (comparison.by) {
        case CompareBy::nothing:
            return;
        case CompareBy::flip:
            background().AddImage(comparison.flipped ? other_.id() : edited_.id(), min_, max_);
            return draw_label(comparison.flipped ? a : b, min_, max_, false);
        case CompareBy::wipe:
            return draw_wipe(comparison, a, b);
        case CompareBy::side_by_side:
            return draw_side_by_side(a, b);
        case CompareBy::difference:
            return draw_difference(comparison);
    }
}

// Draws the wipe. Its line is an ImGui window, so that dragging the line moves no camera.
void ComparisonView::draw_wipe(Comparison& comparison, const std::string& a, const std::string& b) {
    const float width = max_.x - min_.x;
    const auto share = static_cast<float>(comparison.wipe);
    const float x = std::round(min_.x + share * width);
    ImDrawList& list = background();
    list.AddImage(edited_.id(), min_, max_);
    list.AddImage(other_.id(), min_, {x, max_.y}, {0, 0}, {(x - min_.x) / width, 1});
    list.AddLine({x, min_.y}, {x, max_.y}, white);
    draw_label(a, min_, {x, max_.y}, false);
    draw_label(b, {x, min_.y}, max_, true);
    const float grip = em(.8f);
    ImGui::SetNextWindowPos({x - grip / 2, min_.y});
    ImGui::SetNextWindowSize({grip, max_.y - min_.y});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
    ImGui::Begin("wipe", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoSavedSettings |
                     ImGuiWindowFlags_NoBringToFrontOnFocus);
    ImGui::InvisibleButton("line", {grip, std::max(max_.y - min_.y, 1.f)});
    if (ImGui::IsItemHovered() || ImGui::IsItemActive())
        ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
    if (ImGui::IsItemActive())
        comparison.wipe = std::clamp((ImGui::GetMousePos().x - min_.x) / width, 0.f, 1.f);
    ImGui::End();
    ImGui::PopStyleVar(2);
}

// Draws both pictures in full, at half their size.
void ComparisonView::draw_side_by_side(const std::string& a, const std::string& b) {
    ImDrawList& list = background();
    list.AddRectFilled(min_, max_, theme::plot_back);
    const float half = (max_.x - min_.x) / 2, height = (max_.y - min_.y) / 2;
    const ImVec2 left(min_.x, min_.y + height / 2), middle(min_.x + half, left.y);
    const ImVec2 below(middle.x, left.y + height), right(max_.x, below.y);
    list.AddImage(other_.id(), left, below);
    list.AddImage(edited_.id(), middle, right);
    list.AddLine({middle.x, min_.y}, {middle.x, max_.y}, theme::plot_frame);
    draw_label(a, min_, {middle.x, max_.y}, false);
    draw_label(b, {middle.x, min_.y}, max_, false);
}

// Draws the difference in colours, with the scale of lamina::difference_png().
void ComparisonView::draw_difference(Comparison& comparison) {
    colors_.take(comparison.colors());
    ImDrawList& list = background();
    list.AddImage(edited_.id(), min_, max_);
    const auto opacity = static_cast<int>(std::lround(255 * comparison.strength));
    list.AddImage(colors_.id(), min_, max_, {0, 0}, {1, 1}, IM_COL32(255, 255, 255, opacity));
    const double range = comparison.shown_range();
    const float width = std::min(em(20), max_.x - min_.x - em(2)), line = ImGui::GetFontSize();
    const ImVec2 corner(min_.x + em(1), max_.y - 2 * line - em(1.2f));
    list.AddRectFilled({corner.x - em(.5f), corner.y - em(.4f)},
                       {corner.x + width + em(.5f), corner.y + 2 * line + em(.5f)}, label_back);
    constexpr int steps = 80;
    for (int i = 0; i < steps; ++i) {
        const float from = corner.x + width * static_cast<float>(i) / steps;
        list.AddRectFilled({from, corner.y}, {from + width / steps + 1, corner.y + line * .7f},
                           color_of_share((2 * i + 1.0) / steps - 1));
    }
    const std::string least = fmt::format("-{:.3g}", range),
                      most = fmt::format("{:.3g}/255", range);
    const float y = corner.y + line * .8f;
    list.AddText({corner.x, y}, white, least.c_str());
    list.AddText({corner.x + width / 2 - ImGui::CalcTextSize("0").x / 2, y}, white, "0");
    list.AddText({corner.x + width - ImGui::CalcTextSize(most.c_str()).x, y}, white, most.c_str());
    draw_label(comparison.with == CompareWith::truth ? "B - truth" : "B - A", min_, max_, false);
}

}  // namespace lamina::view
