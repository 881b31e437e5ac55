// SPDX-License-Identifier: Apache-2.0
#include "panels/picture_panels.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>

#include "model/frame_history.h"
#include "model/scene_keys.h"
#include "panels/theme.h"
#include "panels/transfer_drawing.h"

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

// Colours of FrameHistory::stage_names(), in that order. They differ in lightness, too.
constexpr ImU32 stage_colors[] = {IM_COL32(120, 94, 240, 255),  IM_COL32(220, 38, 127, 255),
                                  IM_COL32(178, 102, 210, 255), IM_COL32(254, 97, 0, 255),
                                  IM_COL32(255, 176, 0, 255),   IM_COL32(255, 226, 120, 255),
                                  IM_COL32(0, 158, 115, 255),   IM_COL32(110, 214, 176, 255),
                                  IM_COL32(86, 160, 232, 255),  IM_COL32(120, 124, 132, 255)};

ImU32 color_of(const std::string& stage) {
    const auto& names = FrameHistory::stage_names();
    const auto index = std::ranges::find(names, stage) - names.begin();
    return stage_colors[std::min<std::size_t>(static_cast<std::size_t>(index),
                                              std::size(stage_colors) - 1)];
}

// Rectangle of the graph on the screen, for times from 0 (bottom) to `most_ms` (top).
struct GraphFrame {
    ImVec2 min, max;
    double most_ms = 1;
    float y(double ms) const { return max.y - static_cast<float>(ms / most_ms) * (max.y - min.y); }
};

void draw_axis(const GraphFrame& graph) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(graph.min, graph.max, theme::plot_back);
    for (const double tick : even_ticks(0, graph.most_ms, 5)) {
        const float y = std::round(graph.y(tick));
        list.AddLine({graph.min.x, y}, {graph.max.x, y}, theme::grid);
        const std::string text = fmt::format("{} ms", axis_text(tick).text);
        const ImVec2 size = ImGui::CalcTextSize(text.c_str());
        list.AddText({graph.min.x - size.x - em(.3f), y - size.y / 2}, theme::label, text.c_str());
    }
    list.AddRect(graph.min, graph.max, theme::plot_frame);
}

void tell(const FrameCost& frame) {
    ImGui::BeginTooltip();
    ImGui::Text("%.1f ms%s", frame.ms, frame.moving ? ", moving" : "");
    for (const auto& [stage, ms] : frame.stages)
        ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(color_of(stage)), "%s %.2f ms",
                           stage.c_str(), ms);
    ImGui::EndTooltip();
}

// Draws a bar for each of the newest pictures, as many as fit, from the oldest to the newest.
void draw_bars(const GraphFrame& graph, const std::deque<FrameCost>& frames) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float step = std::round(em(.45f)), width = graph.max.x - graph.min.x;
    const auto fit = static_cast<std::size_t>(std::max(width / step, 1.f));
    const std::size_t first = frames.size() > fit ? frames.size() - fit : 0;
    const ImVec2 mouse = ImGui::GetMousePos();
    for (std::size_t i = first; i < frames.size(); ++i) {
        const float left = graph.min.x + step * static_cast<float>(i - first);
        double below = 0;
        for (const auto& [stage, ms] : frames[i].stages) {
            list.AddRectFilled({left, graph.y(below + ms)}, {left + step - 1, graph.y(below)},
                               color_of(stage));
            below += ms;
        }
        if (ImGui::IsItemHovered() && mouse.x >= left && mouse.x < left + step) tell(frames[i]);
    }
}

void draw_legend(const std::deque<FrameCost>& frames) {
    bool first = true;
    for (const std::string& name : FrameHistory::stage_names()) {
        const bool there = std::ranges::any_of(frames, [&](const FrameCost& frame) {
            return std::ranges::any_of(frame.stages,
                                       [&](const auto& stage) { return stage.first == name; });
        });
        if (!there) continue;
        if (!first) ImGui::SameLine();
        first = false;
        ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(color_of(name)), "%s", name.c_str());
    }
}

}  // namespace

void PicturePanel::draw(PanelContext& context) {
    const Shown& shown = context.shown;
    if (!shown.full) return;
    ImGui::Text("%d x %d pixels in %.0f ms", shown.full->width, shown.full->height,
                shown.statistics.draw_ms);
    ImGui::TextWrapped("%s", shown.statistics.drawn_by.c_str());
    for (const std::string& warning : shown.warnings)
        ImGui::TextWrapped("Warning: %s", warning.c_str());
}

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

// Draws the slider of max_error. Each value is planned and drawn, so it counts when it is released.
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
        // Rounded to the three digits that are shown.
        const double step = std::pow(10, std::floor(std::log10(wanted)) - 2);
        document.set_setting("render.max_error", std::round(wanted / step) * step);
        document.end_step();
        wanted_.reset();
    }
}

void FramesPanel::draw(PanelContext& context) {
    if (context.precision == nullptr) return;
    const FrameHistory& history = context.precision->frames;
    if (history.frames().empty()) {
        ImGui::TextColored(theme::dim, "No picture yet.");
        return;
    }
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x, height = em(7);
    GraphFrame graph{{corner.x + em(4.5f), corner.y + em(.4f)},
                     {corner.x + width, corner.y + height - em(.4f)},
                     1.05 * std::max(history.longest_ms(), 1.0)};
    ImGui::InvisibleButton("graph", {std::max(width, 1.f), height});
    draw_axis(graph);
    draw_bars(graph, history.frames());
    draw_legend(history.frames());
    ImGui::TextColored(theme::dim, "Medians: %.1f ms while something moves, %.1f ms at rest",
                       history.median_ms(true), history.median_ms(false));
}

}  // namespace lamina::view
