// SPDX-License-Identifier: Apache-2.0
#include "panels/transfer_panel.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "lamina/color.h"
#include "lamina/error.h"
#include "model/opacity_slopes.h"
#include "model/transfer_curves.h"
#include "panels/theme.h"
#include "panels/transfer_drawing.h"
#include "panels/typed_input.h"

namespace lamina::view {
namespace {

using Curve = TransferHandle::Curve;

void row(const char* label) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(label);
    ImGui::SameLine(em(6.2f));
    ImGui::SetNextItemWidth(-1);
}

bool number_input(const char* label, double& number) {
    row(label);
    return typed_number((std::string("##") + label).c_str(), number);
}

void help(const char* text) {
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", text);
}

// Draws a preview of a map.
void map_preview(const Colormap& map, ImageColorSpace space) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float width = em(7), height = em(.9f);
    const double from = map.colors.front().value, to = map.colors.back().value;
    constexpr int parts = 48;
    for (int i = 0; i < parts; ++i) {
        const double value = from + (to - from) * (i + .5) / parts;
        const float left = at.x + width * static_cast<float>(i) / parts;
        ImGui::GetWindowDrawList()->AddRectFilled(
            {left, at.y + em(.05f)}, {left + width / parts + 1, at.y + height},
            screen_color(color_at(map.colors, value).above, space));
    }
    ImGui::Dummy({width, height});
    ImGui::SameLine();
}

}  // namespace

void TransferPanel::draw(PanelContext& context) {
    Document& document = context.document;
    if (!document.is_open()) return;
    const ValueHistogram* const histogram = context.shown.histogram.get();
    const bool counted = histogram != nullptr;
    if (fitted_to_ != document.revisions().data || counted != counted_) {
        plot_.fit(document.transfer(), histogram);
        fitted_to_ = document.revisions().data;
        counted_ = counted;
    }
    const ImVec2 all = ImGui::GetContentRegionAvail();
    const float controls = std::min(em(19), all.x / 2);
    ImGui::BeginChild("curves", {all.x - controls - em(.5f), all.y}, false,
                      ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
    const std::string edited = plot_.draw(
        document.transfer(), {histogram, context.value_under_pointer, document.scene().color_space},
        ImGui::GetContentRegionAvail());
    if (!edited.empty()) document.transfer_edited(edited);
    ImGui::EndChild();
    ImGui::SameLine();
    ImGui::BeginChild("numbers", {controls, all.y});
    draw_controls(context);
    ImGui::EndChild();
}

void TransferPanel::draw_controls(PanelContext& context) {
    Document& document = context.document;
    if (ImGui::Button("Presets")) ImGui::OpenPopup("presets");
    draw_presets(context);
    ImGui::SameLine();
    if (ImGui::Button("Show all")) plot_.fit(document.transfer(), context.shown.histogram.get());
    help(
        "Shows all values and extinctions. The wheel shows fewer values, the middle button moves "
        "along them");
    ImGui::SameLine();
    ImGui::BeginDisabled(!document.can_undo());
    if (ImGui::Button("Undo")) document.undo();
    ImGui::EndDisabled();
    help(document.can_undo() ? document.undo_name().c_str() : "Ctrl+Z");
    ImGui::SameLine();
    ImGui::BeginDisabled(!document.can_redo());
    if (ImGui::Button("Redo")) document.redo();
    ImGui::EndDisabled();
    ImGui::Separator();
    draw_selected(document);
    ImGui::Separator();
    draw_maps(context);
    draw_whole(document);
}

// Draws the presets. Shapes are placed at the selected point, else in the middle of the data.
void TransferPanel::draw_presets(PanelContext& context) {
    if (!ImGui::BeginPopup("presets")) return;
    if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape))) ImGui::CloseCurrentPopup();
    Document& document = context.document;
    TransferEditor& editor = document.transfer();
    if (ImGui::MenuItem("From the data (auto)")) document.choose_transfer_function();
    ImGui::Separator();
    const ValueSpan span = span_of(context);
    double at = (span.lo + span.hi) / 2, densest = 0;
    for (const TransferHandle& point : editor.selection())
        if (point.curve == Curve::density) at = editor.curves().density[point.index].value;
    for (const DensityPoint& point : editor.curves().density)
        densest = std::max(densest, point.extinction);
    if (densest == 0) densest = 1;
    const auto shape = [&](const char* name, const std::vector<DensityPoint>& points) {
        if (ImGui::MenuItem(name) && editor.set_density(points)) document.transfer_edited(name);
    };
    shape("Ramp", ramp_shape(span.lo, span.hi, densest));
    shape("Peak", peak_shape(span.lo, span.hi, at, densest));
    shape("Step", step_shape(span.lo, span.hi, at, densest));
    ImGui::Separator();
    const ImageColorSpace space = document.scene().color_space;
    for (const std::string& name : colormap_names()) {
        ImGui::PushID(name.c_str());
        map_preview(load_colormap(name, space), space);
        if (ImGui::MenuItem(name.c_str())) apply_map(context, name);
        ImGui::PopID();
    }
    ImGui::EndPopup();
}

void TransferPanel::draw_selected(Document& document) {
    const auto& selection = document.transfer().selection();
    const TransferCurves& curves = document.transfer().curves();
    if (selection.empty()) {
        ImGui::TextColored(theme::dim, "Double click adds a point");
        return;
    }
    if (selection.size() > 1) {
        ImGui::TextColored(theme::dim, "%zu points are selected", selection.size());
        return;
    }
    const TransferHandle point = *selection.begin();
    if (point.curve == Curve::density) return draw_density_point(document, point.index);
    const ColorPoint stop = curves.colors[point.index];
    double value = stop.value;
    if (number_input("value", value) && document.transfer().set_value(point, value))
        document.transfer_edited("value");
    glm::vec3 display(display_of_color(stop.color, document.scene().color_space));
    row("colour");
    if (ImGui::ColorEdit3("##stop", &display.r)) {
        document.transfer().set_color(
            point.index, color_of_display(glm::dvec3(display), document.scene().color_space));
        document.transfer_edited("colour");
    }
}

void TransferPanel::draw_density_point(Document& document, std::size_t index) {
    TransferEditor& editor = document.transfer();
    const DensityPoint point = editor.curves().density[index];
    double value = point.value, extinction = point.extinction;
    double opacity = opacity_of(extinction, editor.unit_length());
    if (number_input("value", value) && editor.set_value({Curve::density, index}, value))
        document.transfer_edited("value");
    if (number_input("extinction", extinction) && editor.set_extinction(index, extinction))
        document.transfer_edited("extinction");
    help("Per world unit");
    if (number_input("opacity", opacity) && editor.set_opacity(index, opacity))
        document.transfer_edited("opacity");
    help("Over unit_length");
    draw_color(document, point.value, color_at(editor.curves().colors, point.value).above);
    bool smooth = point.smooth;
    row("smooth");
    if (ImGui::Checkbox("##smooth", &smooth) && editor.set_smooth(index, smooth))
        document.transfer_edited("smooth");
    help(
        "The pieces on both sides stand for a curve without a corner here, which may be followed "
        "within 1.3e-3 of their extinction");
}

// Draws the colour at a point of extinction. Changing it adds a colour stop at the point's value.
void TransferPanel::draw_color(Document& document, double value, const glm::dvec3& color) {
    const ImageColorSpace space = document.scene().color_space;
    glm::vec3 display(display_of_color(color, space));
    row("colour");
    if (ImGui::ColorEdit3("##color", &display.r)) {
        document.transfer().paint(value, color_of_display(glm::dvec3(display), space));
        document.transfer_edited("colour");
    }
    help("Display values (sRGB)");
}

void TransferPanel::draw_whole(Document& document) {
    TransferEditor& editor = document.transfer();
    draw_density_slider(document);
    double length = editor.unit_length();
    if (number_input("unit_length", length)) editor.set_unit_length(length);
    help("World length that opacities are shown for. It changes no extinction");
    draw_between(document);
    ImGui::Checkbox("Colours move along with points", &editor.colors_move_along);
}

void TransferPanel::draw_density_slider(Document& document) {
    constexpr double least = 1e-3, most = 1e3;
    row("density");
    ImGui::SliderScalar("##density", ImGuiDataType_Double, &density_, &least, &most, "x %.3g",
                        ImGuiSliderFlags_Logarithmic);
    help("All extinctions times a factor");
    TransferEditor& editor = document.transfer();
    if (ImGui::IsItemActivated()) editor.begin_move();
    if (ImGui::IsItemActive() && editor.is_moving()) {
        editor.attenuate(density_);
        document.transfer_edited("density");
    } else if (density_ != 1) {
        editor.end_move();
        density_ = 1;
    }
}

void TransferPanel::draw_between(Document& document) {
    TransferEditor& editor = document.transfer();
    const TransferCurves& curves = editor.curves();
    // Constant pieces and steps are equal in both interpolations and do not count.
    const auto count = [&](bool opacity) {
        std::size_t found = 0;
        for (std::size_t i = 0; i + 1 < curves.density.size(); ++i) {
            const DensityPoint &a = curves.density[i], &b = curves.density[i + 1];
            if (a.value < b.value && a.extinction != b.extinction &&
                (a.opacity_length > 0) == opacity)
                ++found;
        }
        return found;
    };
    const char* const now = curves.palette      ? "nearest"
                            : count(true) == 0  ? "extinction"
                            : count(false) == 0 ? "linear"
                                                : "mixed";
    row("interpolation");
    if (!ImGui::BeginCombo("##between", now)) return;
    if (ImGui::Selectable("linear (opacity)") && editor.set_palette(false) &&
        editor.set_opacity_linear(true))
        document.transfer_edited("interpolation");
    if (ImGui::Selectable("extinction") && editor.set_palette(false) &&
        editor.set_opacity_linear(false))
        document.transfer_edited("interpolation");
    if (ImGui::Selectable("nearest (palette)") && editor.set_palette(true))
        document.transfer_edited("interpolation");
    ImGui::EndCombo();
}

void TransferPanel::draw_maps(PanelContext& context) {
    row("colormap");
    if (typed_text("##file", "name or file (JSON)", map_file_)) apply_map(context, map_file_);
    row("  over");
    if (ImGui::RadioButton("data", !over_points_)) over_points_ = false;
    ImGui::SameLine();
    if (ImGui::RadioButton("points", over_points_)) over_points_ = true;
    help("What a map without a range of its own is stretched over (colormap_range)");
    if (!map_message_.empty()) {
        ImGui::PushTextWrapPos();
        ImGui::TextColored(theme::bad, "%s", map_message_.c_str());
        ImGui::PopTextWrapPos();
    }
}

// Returns the range for maps and shapes: that of the data, or that of the points.
ValueSpan TransferPanel::span_of(const PanelContext& context) const {
    const auto& points = context.document.transfer().curves().density;
    const ValueHistogram* const histogram = context.shown.histogram.get();
    if (!over_points_ && histogram != nullptr && histogram->least < histogram->most)
        return {histogram->least, histogram->most};
    const double lo = points.front().value, hi = points.back().value;
    return lo < hi ? ValueSpan{lo, hi} : ValueSpan{lo, lo + 1};
}

void TransferPanel::apply_map(PanelContext& context, const std::string& name_or_path) {
    TransferEditor& editor = context.document.transfer();
    const auto [lo, hi] = span_of(context);
    map_message_.clear();
    try {
        const Colormap map = load_colormap(name_or_path, context.document.scene().color_space);
        if (editor.recolor(map, lo, hi, true))
            context.document.transfer_edited("colour map");
        else
            map_message_ = "The map has a single value, or the range is empty";
    } catch (const Error& error) {
        map_message_ = error.what();
    }
}

}  // namespace lamina::view
