// SPDX-License-Identifier: Apache-2.0
#include "panels/precision_panels.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <exception>
#include <optional>
#include <string>

#include "model/document.h"
#include "model/factors_text.h"
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
