// SPDX-License-Identifier: Apache-2.0
#include "panels/help_window.h"

#include <imgui.h>

#include <span>

#include "panels/theme.h"

namespace lamina::view {
namespace {

struct HelpLine {
    const char *input, *effect;
};

constexpr HelpLine of_picture[] = {{"Left drag", "turn around what is looked at"},
                                   {"Middle or Shift drag", "move sideways"},
                                   {"Wheel, right drag", "nearer and farther"},
                                   {"Double click", "look at the point that is seen"},
                                   {"W A S D, Q E", "fly ahead, aside, back; down and up"},
                                   {"F", "fit the data"},
                                   {"X Y Z, Shift, 1 to 6", "look along an axis"},
                                   {"P", "perspective or orthographic"},
                                   {"Home", "the automatic camera"},
                                   {"C", "coarse pictures while something moves"},
                                   {"T", "trace at rest"}};

constexpr HelpLine of_comparison[] = {
    {"N", "keep this picture as A; what is edited is B"},
    {"B", "A in the place of B, and back"},
    {"M", "another way to compare: wipe, side by side, difference"},
    {"V", "with A or with the truth"}};

constexpr HelpLine of_transfer_function[] = {
    {"Double click", "new point; below the curves, new colour"},
    {"Drag", "move points; a rectangle selects"},
    {"Shift or Ctrl click", "select more"},
    {"Right click", "menu of the selected points"},
    {"Right drag", "level along the values, window up and down"},
    {"Wheel, middle drag", "fewer values, along the values"},
    {"Arrows", "nudge by a pixel; with Shift by ten"},
    {"Delete", "delete the selected points"},
    {"Ctrl+A", "select all"},
    {"Esc", "take a drag back, or select nothing"}};

constexpr HelpLine of_all[] = {{"Ctrl+O, Ctrl+S, Ctrl+E", "open, save the scene, save the picture"},
                               {"Ctrl+Z", "undo"},
                               {"Ctrl+Y, Ctrl+Shift+Z", "redo"},
                               {"Ctrl click on a number", "type it"},
                               {"Tab", "show or hide the panels"},
                               {"F1", "this help"},
                               {"Ctrl+Q", "quit"}};

void table(const char* title, std::span<const HelpLine> lines) {
    ImGui::TextColored(theme::dim, "%s", title);
    if (!ImGui::BeginTable(title, 2, ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingFixedFit))
        return;
    ImGui::TableSetupColumn("input", ImGuiTableColumnFlags_WidthFixed, em(11.5f));
    for (const HelpLine& line : lines) {
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(line.input);
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(line.effect);
    }
    ImGui::EndTable();
    ImGui::Spacing();
}

}  // namespace

void help_window(bool& open) {
    if (!open) return;
    const ImVec2 middle = ImGui::GetMainViewport()->GetCenter();
    ImGui::SetNextWindowPos(middle, ImGuiCond_Appearing, {.5f, .5f});
    if (ImGui::Begin("Keys and pointer", &open,
                     ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse)) {
        table("Picture", of_picture);
        table("Comparison", of_comparison);
        table("Transfer function", of_transfer_function);
        table("Everywhere", of_all);
        if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape))) open = false;
    }
    ImGui::End();
}

}  // namespace lamina::view
