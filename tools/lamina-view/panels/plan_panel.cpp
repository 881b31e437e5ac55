// SPDX-License-Identifier: Apache-2.0
#include "panels/plan_panel.h"

#include <imgui.h>

#include <string>

#include "panels/theme.h"

namespace lamina::view {
namespace {

void fact(const char* name, const std::string& value) {
    ImGui::TextColored(theme::dim, "%s", name);
    ImGui::SameLine(em(8.5f));
    ImGui::PushTextWrapPos();
    ImGui::TextUnformatted(value.c_str());
    ImGui::PopTextWrapPos();
}

std::string in_255ths(double error) {
    char text[48];
    std::snprintf(text, sizeof text, "%.3g / 255", error);
    return text;
}

void left_out(const PlanSummary& plan) {
    if (plan.left_out.empty()) return;
    if (!ImGui::TreeNodeEx("left out", ImGuiTreeNodeFlags_SpanAvailWidth, "Left out (%zu)",
                           plan.left_out.size()))
        return;
    for (const PlanSummary::LeftOut& one : plan.left_out) {
        ImGui::Bullet();
        ImGui::TextUnformatted(one.name.c_str());
        ImGui::Indent();
        wrapped(theme::dim, one.reason);
        ImGui::Unindent();
    }
    ImGui::TreePop();
}

}  // namespace

void PlanPanel::draw(PanelContext& context) {
    const Shown& shown = context.shown;
    if (!shown.failure.empty()) {
        wrapped(theme::bad, shown.failure);
        if (shown.full) wrapped(theme::dim, "The picture is the last one that could be drawn.");
    }
    if (!shown.resolved) return;
    const Scene& scene = *shown.resolved;
    fact("method", name_of(scene.method));
    if (scene.method == Method::trace) {
        fact("error", in_255ths(shown.statistics.trace_error) + ", as the tracer estimates it");
        return;
    }
    fact("target", name_of(shown.plan.target));
    if (shown.plan.method == Method::slice) fact("slabs", std::to_string(shown.plan.slabs));
    fact("error", text_of(shown.plan.error));
    left_out(shown.plan);
    if (!shown.explanation.empty() &&
        ImGui::TreeNodeEx("Explanation", ImGuiTreeNodeFlags_SpanAvailWidth)) {
        wrapped(ImGui::GetStyleColorVec4(ImGuiCol_Text), shown.explanation);
        ImGui::TreePop();
    }
}

}  // namespace lamina::view
