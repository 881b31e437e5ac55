// SPDX-License-Identifier: Apache-2.0
#include "panels/attempts_panel.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <exception>
#include <optional>

#include "model/document.h"
#include "model/frame_history.h"
#include "panels/theme.h"

namespace lamina::view {

void error_and_time_columns() {
    for (const char* name : {"expected", "Linf", "L2", "traced", "ms"})
        ImGui::TableSetupColumn(name);
}

void error_and_time_cells(const Attempt& attempt) {
    const bool measured = attempt.share_measured > 0;
    ImGui::TableNextColumn();
    if (attempt.expected) ImGui::Text("%.3g", *attempt.expected);
    ImGui::TableNextColumn();
    if (measured) {
        const bool missed = attempt.error.linf > attempt.resolved.max_error;
        ImGui::TextColored(missed ? theme::warning : ImGui::GetStyleColorVec4(ImGuiCol_Text),
                           "%.3g", attempt.error.linf);
    }
    ImGui::TableNextColumn();
    if (measured) ImGui::Text("%.2g", attempt.error.l2);
    ImGui::TableNextColumn();
    if (measured) ImGui::Text("%.0f %%", 100 * attempt.share_measured);
    ImGui::TableNextColumn();
    ImGui::Text("%.3g", attempt.frame_ms);
}

void AttemptsPanel::draw(PanelContext& context) {
    if (context.precision == nullptr) return;
    if (context.precision->attempts.rows().empty()) {
        ImGui::TextColored(theme::dim, "Each picture that is drawn in full gets a row here.");
        return;
    }
    draw_saving(context);
    draw_table(context);
}

void AttemptsPanel::draw_table(PanelContext& context) {
    Attempts& attempts = context.precision->attempts;
    constexpr ImGuiTableFlags flags = ImGuiTableFlags_RowBg | ImGuiTableFlags_ScrollY |
                                      ImGuiTableFlags_BordersInnerV |
                                      ImGuiTableFlags_SizingFixedFit;
    if (!ImGui::BeginTable("attempts", 12, flags, {0, em(13)})) return;
    ImGui::TableSetupScrollFreeze(0, 1);
    for (const char* name :
         {"view", "method", "classification", "target", "tree", "slabs", "wanted"})
        ImGui::TableSetupColumn(name);
    error_and_time_columns();
    ImGui::TableHeadersRow();
    std::optional<Scene> chosen;
    for (std::size_t row = 0; row < attempts.rows().size(); ++row) {
        const Attempt& attempt = attempts.rows()[row];
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        const std::string name = fmt::format("{}##{}", attempt.view, row);
        if (ImGui::Selectable(name.c_str(), row == attempts.newest(),
                              ImGuiSelectableFlags_SpanAllColumns))
            chosen = attempt.scene;
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("Go back to these settings and this view");
        for (const std::string& text : {attempt.method, attempt.classification, attempt.target,
                                        attempt.tree, attempt.samples}) {
            ImGui::TableNextColumn();
            ImGui::TextUnformatted(text.c_str());
        }
        ImGui::TableNextColumn();
        ImGui::Text("%.3g", attempt.resolved.max_error);
        error_and_time_cells(attempt);
    }
    ImGui::EndTable();
    if (chosen) PrecisionInSight::go_on_with(context.document, std::move(*chosen), false);
}

void AttemptsPanel::draw_saving(const PanelContext& context) {
    if (file_.empty())
        file_ = (context.document.scene().file.parent_path() / "attempts.csv").string();
    ImGui::SetNextItemWidth(em(18));
    ImGui::InputText("##file", &file_);
    ImGui::SameLine();
    if (ImGui::Button("Save the table")) {
        try {
            save_text(file_, context.precision->attempts.csv());
            message_ = fmt::format("{} rows written", context.precision->attempts.rows().size());
            failed_ = false;
        } catch (const std::exception& error) {
            message_ = error.what();
            failed_ = true;
        }
    }
    ImGui::SameLine();
    if (ImGui::Button("Clear")) context.precision->attempts.clear();
    ImGui::SameLine();
    ImGui::TextColored(failed_ ? theme::bad : theme::dim, "%s", message_.c_str());
}

}  // namespace lamina::view
