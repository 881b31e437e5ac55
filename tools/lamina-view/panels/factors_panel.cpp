// SPDX-License-Identifier: Apache-2.0
#include "panels/factors_panel.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <exception>
#include <optional>

#include "model/factors_text.h"
#include "model/frame_history.h"
#include "panels/attempts_panel.h"
#include "panels/theme.h"

namespace lamina::view {

void FactorsPanel::draw(PanelContext& context) {
    Document& document = context.document;
    if (!document.is_open()) return;
    if (document.scene().method == Method::trace) {
        ImGui::TextColored(theme::dim, "The tracer has no tree.");
        return;
    }
    if (const std::string now = factors_text(document.scene()); now != shown_) {
        shown_ = text_ = now;
        message_.clear();
    }
    ImGui::SetNextItemWidth(-em(4));
    const bool entered =
        ImGui::InputText("##factors", &text_, ImGuiInputTextFlags_EnterReturnsTrue);
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip(
            "Children of a node, from the root to the leaves: [16, 8, 4], 16x8x4, "
            "4^5, auto or none");
    ImGui::SameLine();
    if ((ImGui::Button("Draw") || entered) && text_ != shown_) take(document);
    if (!message_.empty()) {
        ImGui::PushTextWrapPos();
        ImGui::TextColored(theme::bad, "%s", message_.c_str());
        ImGui::PopTextWrapPos();
    }
    if (context.precision != nullptr) draw_tried(context);
}

void FactorsPanel::take(Document& document) {
    try {
        document.replace(with_factors(document.scene(), text_), "factors");
        document.end_step();
        message_.clear();
    } catch (const std::exception& error) {
        message_ = error.what();
    }
}

void FactorsPanel::draw_tried(PanelContext& context) {
    const Attempts& attempts = context.precision->attempts;
    const std::vector<std::size_t> alike = attempts.alike(without_tree);
    if (alike.empty()) return;
    constexpr ImGuiTableFlags flags =
        ImGuiTableFlags_RowBg | ImGuiTableFlags_BordersInnerV | ImGuiTableFlags_SizingFixedFit;
    if (!ImGui::BeginTable("factors", 6, flags)) return;
    ImGui::TableSetupColumn("factors");
    error_and_time_columns();
    ImGui::TableHeadersRow();
    std::optional<Scene> chosen;
    for (const std::size_t row : alike) {
        const Attempt& attempt = attempts.rows()[row];
        const std::string tree = attempt.tree.empty() ? "none" : attempt.tree;
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        if (ImGui::Selectable(fmt::format("{}##{}", tree, row).c_str(), row == attempts.newest(),
                              ImGuiSelectableFlags_SpanAllColumns))
            chosen = attempt.scene;
        error_and_time_cells(attempt);
    }
    ImGui::EndTable();
    if (chosen) PrecisionInSight::go_on_with(context.document, std::move(*chosen), true);
}

}  // namespace lamina::view
