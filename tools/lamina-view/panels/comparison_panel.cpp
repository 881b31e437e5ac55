// SPDX-License-Identifier: Apache-2.0
#include "panels/comparison_panel.h"

#include <fmt/format.h>
#include <imgui.h>

#include <string>

#include "model/attempts.h"
#include "model/frame_history.h"
#include "panels/theme.h"

namespace lamina::view {
namespace {

void draw_pin(PanelContext& context) {
    Comparison& comparison = context.precision->comparison;
    const bool drawn = context.shown.full && context.shown.kind != PictureKind::moving;
    ImGui::BeginDisabled(!drawn);
    if (ImGui::Button("Pin this as A")) context.precision->pin(context.document, context.shown);
    ImGui::EndDisabled();
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip("Keeps this picture as A. What is changed from here on is B.");
    if (!comparison.pinned()) return;
    ImGui::SameLine();
    if (ImGui::Button("Go on with A"))
        PrecisionInSight::go_on_with(context.document, comparison.pinned()->scene, true);
    ImGui::SameLine();
    if (ImGui::Button("Unpin")) comparison.unpin();
}

void draw_two(const PanelContext& context) {
    const Comparison& comparison = context.precision->comparison;
    const bool truth = comparison.with == CompareWith::truth;
    if (truth)
        wrapped(theme::dim, "A: the truth, as far as it is traced");
    else if (comparison.pinned())
        wrapped(theme::dim,
                "A: " + short_text(comparison.pinned()->resolved) +
                    fmt::format("; {:.1f} ms", frame_ms_of(comparison.pinned()->statistics)));
    if (context.shown.resolved)
        wrapped(theme::dim, "B: " + short_text(*context.shown.resolved) +
                                fmt::format("; {:.1f} ms", frame_ms_of(context.shown.statistics)));
}

template <typename Value>
void choice(const char* label, Value& value, Value of) {
    if (ImGui::RadioButton(label, value == of)) value = of;
}

void draw_choices(Comparison& comparison) {
    ImGui::TextColored(theme::dim, "with");
    ImGui::SameLine(em(4));
    choice("A", comparison.with, CompareWith::pinned);
    ImGui::SameLine();
    choice("the truth", comparison.with, CompareWith::truth);
    ImGui::TextColored(theme::dim, "by");
    ImGui::SameLine(em(4));
    choice("nothing", comparison.by, CompareBy::nothing);
    ImGui::SameLine();
    choice("key", comparison.by, CompareBy::flip);
    ImGui::SameLine();
    choice("wipe", comparison.by, CompareBy::wipe);
    ImGui::NewLine();
    ImGui::SameLine(em(4));
    choice("side by side", comparison.by, CompareBy::side_by_side);
    ImGui::SameLine();
    choice("difference", comparison.by, CompareBy::difference);
}

void draw_difference(Comparison& comparison) {
    bool automatic = !comparison.range;
    if (ImGui::Checkbox("scale to fit", &automatic)) {
        if (automatic)
            comparison.range.reset();
        else
            comparison.range = comparison.shown_range();
    }
    if (comparison.range) {
        auto range = static_cast<float>(*comparison.range);
        ImGui::SetNextItemWidth(-1);
        if (ImGui::SliderFloat("##range", &range, static_cast<float>(smallest_range), 255,
                               "+-%.3g / 255", ImGuiSliderFlags_Logarithmic))
            comparison.range = range;
    }
    ImGui::SetNextItemWidth(-1);
    ImGui::SliderFloat("##strength", &comparison.strength, 0, 1, "%.2f over the picture");
}

}  // namespace

void ComparisonPanel::draw(PanelContext& context) {
    if (context.precision == nullptr || !context.document.is_open()) return;
    Comparison& comparison = context.precision->comparison;
    draw_pin(context);
    draw_two(context);
    draw_choices(comparison);
    if (comparison.by == CompareBy::flip)
        wrapped(theme::dim,
                comparison.flipped ? "A is seen. Key B: back to B." : "B is seen. Key B: A.");
    if (comparison.by == CompareBy::difference) draw_difference(comparison);
    if (!comparison.missing().empty()) {
        if (comparison.by != CompareBy::nothing) wrapped(theme::warning, comparison.missing());
        return;
    }
    const ErrorNorms norms = comparison.norms();
    wrapped(ImGui::GetStyleColorVec4(ImGuiCol_Text),
            fmt::format("B - {}: Linf {:.4g}, L2 {:.4g}, mean {:+.4g} / 255",
                        comparison.with == CompareWith::truth ? "truth" : "A", norms.linf, norms.l2,
                        norms.mean));
}

}  // namespace lamina::view
