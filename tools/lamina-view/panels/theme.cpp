// SPDX-License-Identifier: Apache-2.0
#include "panels/theme.h"

#include <cmath>
#include <filesystem>

namespace lamina::view {
namespace {

constexpr float font_size = 15;

// Fonts that scale. ImGui's own font, sharp at 13 pixels only, is used if none is installed.
constexpr const char* fonts[] = {"/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
                                 "/usr/share/fonts/TTF/DejaVuSans.ttf",
                                 "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf",
                                 "/usr/share/fonts/truetype/noto/NotoSans-Regular.ttf",
                                 "/usr/share/fonts/truetype/liberation/LiberationSans-Regular.ttf"};

void load_font(float scale) {
    ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
    std::error_code unknown;
    for (const char* file : fonts) {
        if (std::filesystem::exists(file, unknown) &&
            atlas.AddFontFromFileTTF(file, std::round(font_size * scale)) != nullptr)
            return;
    }
    ImFontConfig config;
    config.SizePixels = std::round(13 * scale);
    atlas.AddFontDefault(&config);
}

ImVec4 grey(float level, float opacity = 1) {
    return {level, level * 1.015f, level * 1.045f, opacity};
}

void set_colors(ImGuiStyle& style) {
    ImGui::StyleColorsDark(&style);
    const ImVec4 accent(.24f, .43f, .63f, 1), bright(.3f, .53f, .77f, 1);
    ImVec4* const colors = style.Colors;
    colors[ImGuiCol_Text] = grey(.88f);
    colors[ImGuiCol_TextDisabled] = grey(.48f);
    colors[ImGuiCol_WindowBg] = grey(.125f);
    colors[ImGuiCol_ChildBg] = grey(.125f, 0);
    colors[ImGuiCol_PopupBg] = grey(.14f);
    colors[ImGuiCol_Border] = grey(.24f);
    colors[ImGuiCol_FrameBg] = grey(.195f);
    colors[ImGuiCol_FrameBgHovered] = grey(.24f);
    colors[ImGuiCol_FrameBgActive] = grey(.28f);
    colors[ImGuiCol_TitleBg] = colors[ImGuiCol_TitleBgActive] = grey(.16f);
    colors[ImGuiCol_ScrollbarBg] = grey(.11f, .6f);
    colors[ImGuiCol_ScrollbarGrab] = grey(.28f);
    colors[ImGuiCol_CheckMark] = bright;
    colors[ImGuiCol_SliderGrab] = accent;
    colors[ImGuiCol_SliderGrabActive] = bright;
    colors[ImGuiCol_Button] = grey(.22f);
    colors[ImGuiCol_ButtonHovered] = grey(.29f);
    colors[ImGuiCol_ButtonActive] = accent;
    colors[ImGuiCol_Header] = grey(.19f);
    colors[ImGuiCol_HeaderHovered] = grey(.24f);
    colors[ImGuiCol_HeaderActive] = grey(.27f);
    colors[ImGuiCol_Separator] = grey(.22f);
    colors[ImGuiCol_TextSelectedBg] = accent;
    colors[ImGuiCol_PlotHistogram] = accent;
    colors[ImGuiCol_NavHighlight] = bright;
    colors[ImGuiCol_TableBorderLight] = colors[ImGuiCol_TableBorderStrong] = grey(.22f);
    colors[ImGuiCol_TableRowBgAlt] = grey(1, .02f);
}

}  // namespace

float em(float lengths) {
    return lengths * ImGui::GetFontSize();
}

void set_theme(float scale) {
    load_font(scale);
    ImGuiStyle& style = ImGui::GetStyle();
    set_colors(style);
    style.WindowPadding = {10, 8};
    style.FramePadding = {7, 3};
    style.ItemSpacing = {8, 5};
    style.ItemInnerSpacing = {6, 4};
    style.IndentSpacing = 14;
    style.ScrollbarSize = 12;
    style.GrabMinSize = 10;
    style.WindowRounding = style.ChildRounding = style.PopupRounding = 4;
    style.FrameRounding = style.GrabRounding = 3;
    style.ScrollbarRounding = 6;
    style.WindowBorderSize = 0;
    style.PopupBorderSize = 1;
    style.ScaleAllSizes(scale);
}

void wrapped(const ImVec4& color, const std::string& text) {
    ImGui::PushTextWrapPos();
    ImGui::TextColored(color, "%s", text.c_str());
    ImGui::PopTextWrapPos();
}

}  // namespace lamina::view
