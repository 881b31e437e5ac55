// SPDX-License-Identifier: Apache-2.0
#include "panels/typed_input.h"

#include <imgui.h>
#include <imgui_stdlib.h>

#include <utility>

#include "panels/theme.h"

namespace lamina::view {
namespace {

// The unfinished input of the active field. Only one field can be active. ImGui deactivates a field
// that Tab leaves before the field is drawn again, so its input is kept here.
template <typename Value>
struct Typed {
    ImGuiID field = 0;
    Value value{};
};

// Draws a field and returns true once its input ends; changes `value` only then.
template <typename Value, typename Draw>
bool typed(const char* id, Value& value, const Draw& draw) {
    static Typed<Value> last;
    const ImGuiID field = ImGui::GetID(id);
    Value edited = last.field == field ? last.value : value;
    if (draw(edited)) last = {field, edited};
    const bool ended = ImGui::IsItemDeactivatedAfterEdit() && last.field == field;
    if (ended) value = last.value;
    if (last.field == field && !ImGui::IsItemActive()) last = {};
    return ended;
}

}  // namespace

bool typed_number(const char* id, double& number) {
    return typed(id, number,
                 [&](double& edited) { return ImGui::InputDouble(id, &edited, 0, 0, "%.9g"); });
}

bool typed_text(const char* id, const char* hint, std::string& text) {
    return typed(id, text,
                 [&](std::string& edited) { return ImGui::InputTextWithHint(id, hint, &edited); });
}

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
