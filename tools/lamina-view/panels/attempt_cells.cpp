// SPDX-License-Identifier: Apache-2.0
#include "panels/attempt_cells.h"

#include <imgui.h>

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

}  // namespace lamina::view
