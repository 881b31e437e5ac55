// SPDX-License-Identifier: Apache-2.0
#include "panels/path_prompt.h"

#include <imgui.h>
#include <imgui_stdlib.h>

#include <utility>

#include "panels/theme.h"

namespace lamina::view {

void PathPrompt::ask(std::string title, std::string path, Take take) {
    title_ = std::move(title);
    path_ = std::move(path);
    wrong_.clear();
    take_ = std::move(take);
    open_ = first_frame_ = true;
}

void PathPrompt::draw() {
    if (!open_) return;
    if (first_frame_) ImGui::OpenPopup(title_.c_str());
    const ImVec2 middle = ImGui::GetMainViewport()->GetCenter();
    ImGui::SetNextWindowPos(middle, ImGuiCond_Appearing, {.5f, .5f});
    if (!ImGui::BeginPopupModal(title_.c_str(), &open_, ImGuiWindowFlags_AlwaysAutoResize)) return;
    if (std::exchange(first_frame_, false)) ImGui::SetKeyboardFocusHere();
    ImGui::SetNextItemWidth(em(34));
    const bool entered = ImGui::InputText("##path", &path_, ImGuiInputTextFlags_EnterReturnsTrue);
    if (!wrong_.empty()) ImGui::TextColored(theme::bad, "%s", wrong_.c_str());
    const bool pressed = ImGui::Button("OK");
    ImGui::SameLine();
    const bool cancelled =
        ImGui::Button("Cancel") || ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape));
    if (cancelled) {
        open_ = false;
    } else if (entered || pressed) {
        wrong_ = take_(path_);
        open_ = !wrong_.empty();
    }
    if (!open_) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
}

}  // namespace lamina::view
