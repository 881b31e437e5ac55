// SPDX-License-Identifier: Apache-2.0
#include "panels/transfer_drawing.h"

#include <cmath>
#include <cstdio>
#include <vector>

#include "lamina/color.h"
#include "model/opacity_slopes.h"
#include "panels/theme.h"

namespace lamina::view {
namespace {

constexpr float column = 2;  // width of a strip of one colour, in pixels

void label(const ImVec2& at, const char* text, float align_x, float align_y,
           ImU32 color = theme::label) {
    const ImVec2 size = ImGui::CalcTextSize(text);
    ImGui::GetWindowDrawList()->AddText({at.x - align_x * size.x, at.y - align_y * size.y}, color,
                                        text);
}

// Returns the extinction curve on the screen, from left to right. Extinction is linear between
// knots, so the curve bends on a logarithmic axis.
std::vector<ImVec2> curve_points(const TransferFrame& frame, const TransferFunction& function) {
    std::vector<ImVec2> points;
    const auto knots = function.knots();
    std::size_t next = 0;
    while (next < knots.size() && knots[next].value < frame.value_lo) ++next;
    for (float x = frame.min.x;; x += column) {
        const float here = std::min(x, frame.max.x);
        const double value = frame.value(here);
        for (; next < knots.size() && knots[next].value <= value; ++next)
            points.emplace_back(frame.x(knots[next].value), frame.y(knots[next].optics.extinction));
        points.emplace_back(here, frame.y(function.at(value).extinction));
        if (here >= frame.max.x) return points;
    }
}

bool is_step_above(const TransferCurves& curves, std::size_t i) {
    return i > 0 && curves.density[i - 1].value == curves.density[i].value;
}

}  // namespace

AxisText axis_text(double number) {
    AxisText written{};
    std::snprintf(written.text, sizeof written.text, "%.5g", number);
    return written;
}

std::vector<double> even_ticks(double lo, double hi, int most) {
    const double least = (hi - lo) / most;
    const double power = std::pow(10., std::floor(std::log10(least)));
    const double share = least / power;
    const double step = power * (share <= 1 ? 1 : share <= 2 ? 2 : share <= 5 ? 5 : 10);
    std::vector<double> ticks;
    for (double i = std::ceil(lo / step); i * step <= hi && ticks.size() < 100; ++i)
        ticks.push_back(i * step + 0.);  // + 0. turns -0 into 0
    return ticks;
}

ImU32 screen_color(const glm::dvec3& color, ImageColorSpace space, float opacity) {
    const glm::vec3 display(display_of_color(color, space));
    return ImGui::ColorConvertFloat4ToU32({display.r, display.g, display.b, opacity});
}

// Draws the histogram with logarithmic shares, so that rare values are visible.
void draw_histogram(const TransferFrame& frame, const ValueHistogram& histogram) {
    double least = 1, most = 0;
    for (const double share : histogram.shares) {
        if (share > 0) least = std::min(least, share);
        most = std::max(most, share);
    }
    if (!(most > 0)) return;
    const double floor = std::log(least / 2), range = std::log(most) - floor;
    const double width =
        (histogram.hi - histogram.lo) / static_cast<double>(histogram.shares.size());
    ImDrawList& list = *ImGui::GetWindowDrawList();
    for (std::size_t i = 0; i < histogram.shares.size(); ++i) {
        if (!(histogram.shares[i] > 0)) continue;
        const double from = histogram.lo + width * static_cast<double>(i);
        const float left = std::max(frame.x(from), frame.min.x);
        const float right = std::min(std::max(frame.x(from + width), left + 1), frame.max.x);
        if (right <= left) continue;
        const double height = .96 * (std::log(histogram.shares[i]) - floor) / range;
        list.AddRectFilled({left, frame.max.y - frame.height() * static_cast<float>(height)},
                           {right, frame.max.y}, theme::histogram);
    }
}

void draw_extinction_axis(const TransferFrame& frame) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const int most = std::max(3, static_cast<int>(frame.height() / em(1.6f)));
    for (const double tick : frame.axis.ticks(most)) {
        const float y = frame.y(tick);
        if (y < frame.min.y || y > frame.max.y + 1) continue;
        list.AddLine({frame.min.x, y}, {frame.max.x, y}, theme::grid);
        label({frame.min.x - em(.35f), y}, axis_text(tick).text, 1, .5f);
    }
}

void draw_opacity_axis(const TransferFrame& frame, double unit_length) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    float free_below = frame.max.y + em(1);
    for (const double opacity :
         {0., .0001, .001, .01, .03, .1, .2, .3, .5, .7, .8, .9, .95, .99, .999, .9999}) {
        const float y = frame.y(extinction_of(opacity, unit_length));
        if (y < frame.min.y || y > free_below - em(1)) continue;
        free_below = y;
        list.AddLine({frame.max.x, y}, {frame.max.x + em(.25f), y}, theme::label);
        label({frame.max.x + em(.4f), y}, axis_text(opacity).text, 0, .5f);
    }
}

void draw_value_axis(const TransferFrame& frame) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const int most = std::max(2, static_cast<int>(frame.width() / em(6)));
    for (const double tick : even_ticks(frame.value_lo, frame.value_hi, most)) {
        const float x = frame.x(tick);
        list.AddLine({x, frame.min.y}, {x, frame.max.y}, theme::grid);
        list.AddLine({x, frame.max.y}, {x, frame.max.y + em(.25f)}, theme::label);
        label({x, frame.max.y + em(.3f)}, axis_text(tick).text, .5f, 0);
    }
}

void draw_curve(const TransferFrame& frame, const TransferFunction& function,
                ImageColorSpace space) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    for (float x = frame.min.x; x < frame.max.x; x += column) {
        const OpticalProperties here = function.at(frame.value(x + column / 2));
        const float top = std::max(frame.y(here.extinction), frame.min.y);
        list.AddRectFilled({x, top}, {std::min(x + column, frame.max.x), frame.max.y},
                           screen_color(here.color, space, .42f));
    }
    const std::vector<ImVec2> points = curve_points(frame, function);
    list.AddPolyline(points.data(), static_cast<int>(points.size()), theme::curve, 0,
                     std::max(1.5f, em(.1f)));
}

void draw_handles(const TransferFrame& frame, const TransferEditor& editor, ImageColorSpace space) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const TransferCurves& curves = editor.curves();
    for (std::size_t i = 0; i < curves.density.size(); ++i) {
        const DensityPoint& point = curves.density[i];
        const ImVec2 at(frame.x(point.value), frame.y(point.extinction));
        for (const ExtinctionKnot& knot : point.inside) {
            list.AddCircleFilled({frame.x(knot.value), frame.y(knot.extinction)}, em(.1f),
                                 theme::label, 6);
        }
        const bool selected = editor.is_selected({TransferHandle::Curve::density, i});
        const float size = em(selected ? .42f : .34f);
        const ImU32 rim = selected ? theme::selected : theme::handle;
        const ColorSides color = color_at(curves.colors, point.value);
        list.AddCircleFilled(at, size, rim, 20);
        list.AddCircleFilled(
            at, size - em(.11f),
            screen_color(is_step_above(curves, i) ? color.above : color.below, space), 20);
    }
}

void draw_marker(const TransferFrame& frame, const TransferFunction& function, double value) {
    const float x = frame.x(value);
    if (x < frame.min.x || x > frame.max.x) return;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddLine({x, frame.min.y}, {x, frame.max.y}, theme::marker, em(.08f));
    list.AddCircle({x, frame.y(function.at(value).extinction)}, em(.35f), theme::marker, 20,
                   em(.12f));
    const bool right = x > (frame.min.x + frame.max.x) / 2;
    label({x + (right ? -em(.4f) : em(.4f)), frame.min.y + em(.1f)}, axis_text(value).text,
          right ? 1.f : 0.f, 0, theme::marker);
}

void draw_color_strip(const TransferFrame& frame, const ImVec2& min, const ImVec2& max,
                      const TransferFunction& function, ImageColorSpace space) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    for (float x = min.x; x < max.x; x += column) {
        const glm::dvec3 color = function.at(frame.value(x + column / 2)).color;
        list.AddRectFilled({x, min.y}, {std::min(x + column, max.x), max.y},
                           screen_color(color, space));
    }
    list.AddRect(min, max, theme::plot_frame);
}

}  // namespace lamina::view
