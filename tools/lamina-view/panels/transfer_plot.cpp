// SPDX-License-Identifier: Apache-2.0
#include "panels/transfer_plot.h"

#include <algorithm>
#include <cmath>

#include "panels/theme.h"

namespace lamina::view {
namespace {

using Curve = TransferHandle::Curve;

// Returns the largest extinction that the axis should show. Opacity 1 does not count if anything
// else does: its extinction, 1e7 / unit_length, is arbitrary. Slopes reach optical depth 17.
double densest(const TransferEditor& editor) {
    constexpr double opaque_depth = 17.5;
    double most = 0, most_of_all = 0;
    for (const ExtinctionKnot& knot : knots_of(editor.curves().density)) {
        most_of_all = std::max(most_of_all, knot.extinction);
        if (knot.extinction * editor.unit_length() <= opaque_depth)
            most = std::max(most, knot.extinction);
    }
    return most > 0 ? most : most_of_all;
}

float distance(const ImVec2& a, const ImVec2& b) {
    return std::hypot(a.x - b.x, a.y - b.y);
}

bool pressed(ImGuiKey key) {
    return ImGui::IsKeyPressed(ImGui::GetKeyIndex(key));
}

}  // namespace

void TransferPlot::fit(const TransferEditor& editor, const ValueHistogram* histogram) {
    const TransferCurves& curves = editor.curves();
    double lo = curves.density.front().value, hi = curves.density.back().value;
    lo = std::min(lo, curves.colors.front().value);
    hi = std::max(hi, curves.colors.back().value);
    if (histogram != nullptr && !histogram->shares.empty()) {
        lo = std::min(lo, histogram->lo);
        hi = std::max(hi, histogram->hi);
    }
    if (!(lo < hi)) {
        lo -= .5 * std::max(1., std::abs(lo));
        hi += .5 * std::max(1., std::abs(hi));
    }
    frame_.value_lo = lo - .02 * (hi - lo);
    frame_.value_hi = hi + .02 * (hi - lo);
    fit_extinction(editor);
    fitted_ = true;
}

// Fits the extinction axis. Its linear part ends at the faintest point, which is thus drawn off 0,
// but no less than three and no more than six decades below the top.
void TransferPlot::fit_extinction(const TransferEditor& editor) {
    const double most = densest(editor);
    const double top = most > 0 ? std::min(3 * most, 1e300) : 1;
    double faintest = top;
    for (const DensityPoint& point : editor.curves().density)
        if (point.extinction > 0) faintest = std::min(faintest, point.extinction);
    frame_.axis = SymlogAxis(0, top, std::clamp(faintest, 1e-6 * top, 1e-3 * top));
}

// Places the parts of the plot: numbers at the left and right, and the strip of colours with its
// stops below the values.
void TransferPlot::place(const ImVec2& corner, const ImVec2& size) {
    frame_.min = {corner.x + em(3.8f), corner.y + em(.5f)};
    frame_.max = {corner.x + size.x - em(3.4f), corner.y + size.y - em(3.4f)};
    frame_.max.x = std::max(frame_.max.x, frame_.min.x + 10);
    frame_.max.y = std::max(frame_.max.y, frame_.min.y + 10);
    strip_min_ = {frame_.min.x, frame_.max.y + em(1.5f)};
    strip_max_ = {frame_.max.x, frame_.max.y + em(2.5f)};
}

std::optional<TransferHandle> TransferPlot::handle_at(const TransferEditor& editor,
                                                      const ImVec2& at) const {
    std::optional<TransferHandle> found;
    float nearest = em(.7f);
    const TransferCurves& curves = editor.curves();
    const auto look_at = [&](const TransferHandle& handle, const ImVec2& place) {
        const float away = distance(at, place);
        if (away >= nearest) return;
        nearest = away;
        found = handle;
    };
    for (std::size_t i = 0; i < curves.density.size(); ++i) {
        const DensityPoint& point = curves.density[i];
        look_at({Curve::density, i}, {frame_.x(point.value), frame_.y(point.extinction)});
    }
    for (std::size_t i = 0; i < curves.colors.size(); ++i)
        look_at({Curve::color, i}, {frame_.x(curves.colors[i].value), strip_max_.y + em(.3f)});
    return found;
}

void TransferPlot::zoom(float steps, float at_x) {
    const double pivot = frame_.value(at_x), factor = std::pow(.85, static_cast<double>(steps));
    const double lo = pivot + (frame_.value_lo - pivot) * factor;
    const double hi = pivot + (frame_.value_hi - pivot) * factor;
    // Neighbouring values must stay apart on the screen.
    if (hi - lo <= 1e-9 * std::max({std::abs(lo), std::abs(hi), 1e-290})) return;
    frame_.value_lo = lo;
    frame_.value_hi = hi;
}

std::string TransferPlot::press_left(TransferEditor& editor, const ImVec2& at) {
    const bool more = ImGui::GetIO().KeyShift || ImGui::GetIO().KeyCtrl;
    const auto handle = handle_at(editor, at);
    if (!handle) {
        if (ImGui::IsMouseDoubleClicked(0)) {
            if (frame_.holds(at) &&
                editor.add_density(frame_.value(at.x), std::max(0., frame_.extinction(at.y))))
                return "new point";
            if (!frame_.holds(at) && editor.add_color(frame_.value(at.x))) return "new colour";
        }
        if (!more) editor.clear_selection();
        drag_ = Drag::rectangle;
        return {};
    }
    if (more)
        editor.toggle(*handle);
    else if (!editor.is_selected(*handle))
        editor.select_only(*handle);
    if (editor.is_selected(*handle)) {
        editor.begin_move();
        drag_ = Drag::points;
    }
    return {};
}

std::string TransferPlot::drag(TransferEditor& editor) {
    const ImVec2 at = ImGui::GetMousePos();
    const float dx = at.x - pressed_at_.x, dy = at.y - pressed_at_.y;
    switch (drag_) {
        case Drag::none:
        case Drag::rectangle:
            return {};
        case Drag::points:
            editor.move({frame_.values(dx), frame_.places(dy)}, frame_.axis);
            return "move";
        case Drag::window: {
            // A change of width keeps the middle of the points.
            const auto& points = editor.curves().density;
            const double pivot = (value_lo_at_press_ + value_hi_at_press_) / 2;
            if (points.size() > 0)
                editor.window(std::exp(static_cast<double>(-dy) / 150), pivot, frame_.values(dx));
            return "window and level";
        }
        case Drag::pan:
            frame_.value_lo = value_lo_at_press_ - frame_.values(dx);
            frame_.value_hi = value_hi_at_press_ - frame_.values(dx);
            return {};
    }
    return {};
}

void TransferPlot::end_drag(TransferEditor& editor) {
    const ImVec2 at = ImGui::GetMousePos();
    if (drag_ == Drag::rectangle && distance(at, pressed_at_) > em(.3f)) {
        const double low = frame_.extinction(std::max(at.y, pressed_at_.y));
        editor.select_within(frame_.value(std::min(at.x, pressed_at_.x)),
                             frame_.value(std::max(at.x, pressed_at_.x)), low,
                             frame_.extinction(std::min(at.y, pressed_at_.y)));
    }
    editor.end_move();
    drag_ = Drag::none;
}

std::string TransferPlot::take_pointer(TransferEditor& editor) {
    const ImVec2 at = ImGui::GetMousePos();
    const bool hovered = ImGui::IsItemHovered();
    if (hovered && ImGui::GetIO().MouseWheel != 0) zoom(ImGui::GetIO().MouseWheel, at.x);
    std::string edited;
    if (drag_ == Drag::none && ImGui::IsItemActivated()) {
        pressed_at_ = at;
        value_lo_at_press_ = frame_.value_lo;
        value_hi_at_press_ = frame_.value_hi;
        if (ImGui::IsMouseClicked(0)) {
            edited = press_left(editor, at);
        } else if (ImGui::IsMouseClicked(2)) {
            drag_ = Drag::pan;
        } else if (!handle_at(editor, at)) {
            const auto& points = editor.curves().density;
            value_lo_at_press_ = points.front().value;
            value_hi_at_press_ = points.back().value;
            editor.begin_move();
            drag_ = Drag::window;
        }
    } else if (drag_ != Drag::none && ImGui::IsItemActive()) {
        edited = drag(editor);
    } else if (drag_ != Drag::none) {
        end_drag(editor);
    }
    if (hovered && ImGui::IsMouseReleased(1) && distance(at, pressed_at_) < em(.3f)) {
        if (const auto handle = handle_at(editor, at); handle && !editor.is_selected(*handle))
            editor.select_only(*handle);
        ImGui::OpenPopup("points");
    }
    return edited;
}

std::string TransferPlot::take_keys(TransferEditor& editor) {
    if (!ImGui::IsWindowFocused()) return {};
    ImGui::CaptureKeyboardFromApp(true);
    const ImGuiIO& io = ImGui::GetIO();
    if (pressed(ImGuiKey_Escape)) {
        if (editor.is_moving()) {
            editor.cancel_move();
            drag_ = Drag::none;
            return "move";
        }
        editor.clear_selection();
    }
    if (io.KeyCtrl && pressed(ImGuiKey_A)) editor.select_all(Curve::density);
    if ((pressed(ImGuiKey_Delete) || pressed(ImGuiKey_Backspace)) && editor.remove_selected())
        return "delete";
    const auto steps = [&](ImGuiKey more, ImGuiKey less) {
        return static_cast<double>(pressed(more)) - static_cast<double>(pressed(less));
    };
    const double size = io.KeyShift ? 10 : 1;
    const TransferShift shift{
        size * frame_.values(1) * steps(ImGuiKey_RightArrow, ImGuiKey_LeftArrow),
        size * -frame_.places(1) * steps(ImGuiKey_UpArrow, ImGuiKey_DownArrow)};
    if ((shift.values == 0 && shift.places == 0) || editor.selection().empty() ||
        drag_ != Drag::none)
        return {};
    editor.begin_move();
    editor.move(shift, frame_.axis);
    editor.end_move();
    return "nudge";
}

std::string TransferPlot::menu(TransferEditor& editor) {
    std::string edited;
    if (!ImGui::BeginPopup("points")) return edited;
    if (pressed(ImGuiKey_Escape)) ImGui::CloseCurrentPopup();
    const bool any = !editor.selection().empty();
    if (ImGui::MenuItem("Delete", "Del", false, any) && editor.remove_selected()) edited = "delete";
    const bool one = editor.selection().size() == 1;
    if (ImGui::MenuItem("Make a step", nullptr, false, one) &&
        editor.make_step(*editor.selection().begin()))
        edited = "step";
    if (ImGui::MenuItem("Opacity is linear to the next point") && editor.set_opacity_linear(true))
        edited = "linear opacity";
    if (ImGui::MenuItem("Extinction is linear to the next point") &&
        editor.set_opacity_linear(false))
        edited = "linear extinction";
    ImGui::Separator();
    if (ImGui::MenuItem("Select all", "Ctrl+A")) editor.select_all(Curve::density);
    if (ImGui::MenuItem("Show everything")) fitted_ = false;
    ImGui::EndPopup();
    return edited;
}

void TransferPlot::draw_stops(const TransferEditor& editor, ImageColorSpace space) const {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const auto& colors = editor.curves().colors;
    for (std::size_t i = 0; i < colors.size(); ++i) {
        const float x = frame_.x(colors[i].value), y = strip_max_.y + 1, size = em(.36f);
        const bool selected = editor.is_selected({Curve::color, i});
        const ImVec2 top(x, y), left(x - size, y + 1.6f * size), right(x + size, y + 1.6f * size);
        list.AddTriangleFilled(top, right, left, screen_color(colors[i].color, space));
        list.AddTriangle(top, right, left, selected ? theme::selected : theme::label,
                         selected ? em(.14f) : 1);
    }
}

void TransferPlot::draw_all(const TransferEditor& editor,
                            const TransferSurroundings& surroundings) const {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(frame_.min, frame_.max, theme::plot_back);
    draw_extinction_axis(frame_);
    draw_opacity_axis(frame_, editor.unit_length());
    draw_value_axis(frame_);
    list.PushClipRect(frame_.min, frame_.max, true);
    if (surroundings.histogram != nullptr) draw_histogram(frame_, *surroundings.histogram);
    draw_curve(frame_, editor.function(), surroundings.space);
    list.PopClipRect();
    list.AddRect(frame_.min, frame_.max, theme::plot_frame);
    list.PushClipRect({frame_.min.x - em(.5f), frame_.min.y - em(.5f)},
                      {frame_.max.x + em(.5f), strip_max_.y + em(1)}, true);
    draw_handles(frame_, editor, surroundings.space);
    if (surroundings.value_under_pointer)
        draw_marker(frame_, editor.function(), *surroundings.value_under_pointer);
    draw_color_strip(frame_, strip_min_, strip_max_, editor.function(), surroundings.space);
    draw_stops(editor, surroundings.space);
    list.PopClipRect();
    if (drag_ == Drag::rectangle) {
        const ImVec2 at = ImGui::GetMousePos();
        list.AddRectFilled(pressed_at_, at, IM_COL32(255, 255, 255, 18));
        list.AddRect(pressed_at_, at, theme::selected);
    }
}

std::string TransferPlot::draw(TransferEditor& editor, const TransferSurroundings& surroundings,
                               const ImVec2& size) {
    if (!fitted_) fit(editor, surroundings.histogram);
    if (drag_ == Drag::none) {
        const double most = densest(editor);
        if (most > frame_.axis.hi() || (most > 0 && most < 1e-2 * frame_.axis.hi()))
            fit_extinction(editor);
    }
    place(ImGui::GetCursorScreenPos(), size);
    ImGui::InvisibleButton("plot", size,
                           ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight |
                               ImGuiButtonFlags_MouseButtonMiddle);
    std::string edited = take_pointer(editor);
    if (const std::string by_key = take_keys(editor); !by_key.empty()) edited = by_key;
    if (const std::string by_menu = menu(editor); !by_menu.empty()) edited = by_menu;
    draw_all(editor, surroundings);
    return edited;
}

}  // namespace lamina::view
