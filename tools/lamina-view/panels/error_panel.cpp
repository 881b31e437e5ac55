// SPDX-License-Identifier: Apache-2.0
#include "panels/error_panel.h"

#include <fmt/format.h>
#include <imgui.h>

#include <cmath>
#include <string>

#include "model/key_effects.h"
#include "panels/theme.h"

namespace lamina::view {
namespace {

void line(const char* name, const std::string& text, const ImVec4& color) {
    ImGui::TextColored(theme::dim, "%s", name);
    ImGui::SameLine(em(6));
    ImGui::PushTextWrapPos();
    ImGui::TextColored(color, "%s", text.c_str());
    ImGui::PopTextWrapPos();
}

ImVec4 text_color() {
    return ImGui::GetStyleColorVec4(ImGuiCol_Text);
}

void draw_expected(const Shown& shown) {
    const ErrorFigure& expected = shown.plan.error;
    line("expected", text_of(expected), expected.known() ? text_color() : theme::dim);
}

void draw_measured(const Shown& shown, double wanted) {
    if (shown.share_traced <= 0) {
        line("measured", "nothing yet", theme::dim);
        return;
    }
    const bool kept = shown.error.linf <= wanted;
    line("Linf", fmt::format("{:.4g} / 255", shown.error.linf),
         kept ? text_color() : theme::warning);
    line("L2", fmt::format("{:.4g} / 255", shown.error.l2), text_color());
    line("mean", fmt::format("{:+.4g} / 255", shown.error.mean), text_color());
    const auto share = static_cast<float>(shown.share_traced);
    const std::string text = shown.share_traced < 1
                                 ? fmt::format("{:.1f} % traced", 100 * shown.share_traced)
                                 : "all pixels are traced";
    ImGui::ProgressBar(share, {-1, 0}, text.c_str());
}

}  // namespace

void ErrorPanel::draw(PanelContext& context) {
    const Shown& shown = context.shown;
    if (!context.document.is_open()) return;
    if (shown.full && shown.resolved && shown.resolved->method != Method::trace) {
        draw_expected(shown);
        draw_measured(shown, context.document.scene().max_error);
    } else if (shown.full) {
        line("the truth", fmt::format("to {:.3g} / 255", shown.trace_error), text_color());
    }
    draw_wanted(context.document);
}

// Each value is planned and drawn, so the slider counts when it is let go.
void ErrorPanel::draw_wanted(Document& document) {
    const std::string reason = why_without_effect(document.scene(), "render.max_error");
    float wanted = wanted_.value_or(static_cast<float>(document.scene().max_error));
    ImGui::TextColored(theme::dim, "wanted");
    ImGui::SameLine(em(6));
    ImGui::SetNextItemWidth(-1);
    const bool edited = ImGui::SliderFloat("##max_error", &wanted, .05f, 64, "%.3g / 255",
                                           ImGuiSliderFlags_Logarithmic);
    if (edited) wanted_ = wanted;
    if (!reason.empty() && ImGui::IsItemHovered())
        ImGui::SetTooltip("Changes nothing: %s", reason.c_str());
    if (!ImGui::IsItemActive() && wanted_) {
        // Three digits, as it is shown.
        const double step = std::pow(10, std::floor(std::log10(wanted)) - 2);
        document.set_setting("render.max_error", std::round(wanted / step) * step);
        document.end_step();
        wanted_.reset();
    }
}

}  // namespace lamina::view
