// SPDX-License-Identifier: Apache-2.0
#include "panels/typed_input.h"

#include <imgui.h>
#include <imgui_stdlib.h>

namespace lamina::view {
namespace {

// Text of the active input field. ImGui gives a field up before it is drawn again when Tab ends the
// input, so the text is kept here. One field is active at a time.
template <typename Value>
struct Typed {
    ImGuiID field = 0;
    Value value{};
};

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

}  // namespace lamina::view
