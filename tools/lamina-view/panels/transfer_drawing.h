// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <imgui.h>

#include <algorithm>
#include <optional>

#include "lamina/image.h"
#include "lamina/report.h"
#include "model/transfer_curves.h"
#include "model/transfer_editor.h"

namespace lamina::view {

// Maps values and extinctions to the screen: values from `value_lo` to `value_hi` along x,
// extinctions along a symmetric-log axis up y.
struct TransferFrame {
    ImVec2 min, max;  // corners of the area of the curves
    double value_lo = 0, value_hi = 1;
    SymlogAxis axis{0, 1, .01};

    float width() const { return max.x - min.x; }
    float height() const { return max.y - min.y; }
    float x(double value) const {
        return min.x + width() * static_cast<float>((value - value_lo) / (value_hi - value_lo));
    }
    // Extinctions above the axis are drawn at its end.
    float y(double extinction) const {
        return max.y - height() * static_cast<float>(std::min(axis.place(extinction), 1.));
    }
    double value(float at_x) const {
        return value_lo + (value_hi - value_lo) * static_cast<double>((at_x - min.x) / width());
    }
    double extinction(float at_y) const {
        return axis.number(static_cast<double>((max.y - at_y) / height()));
    }
    double values(float pixels) const {
        return (value_hi - value_lo) * static_cast<double>(pixels / width());
    }
    double places(float pixels) const { return static_cast<double>(-pixels / height()); }
    bool holds(const ImVec2& at) const {
        return at.x >= min.x && at.x <= max.x && at.y >= min.y && at.y <= max.y;
    }
};

// Returns a scene's colour as the screen shows it.
ImU32 screen_color(const glm::dvec3& color, ImageColorSpace space, float opacity = 1);

// Draw parts of the plot in ImGui's current window.
void draw_histogram(const TransferFrame& frame, const ValueHistogram& histogram);
void draw_extinction_axis(const TransferFrame& frame);  // on the left
// Draws the axis on the right: opacities over `unit_length`.
void draw_opacity_axis(const TransferFrame& frame, double unit_length);
void draw_value_axis(const TransferFrame& frame);  // below
// Draws the extinction curve over the colours of its values.
void draw_curve(const TransferFrame& frame, const TransferFunction& function,
                ImageColorSpace space);
void draw_handles(const TransferFrame& frame, const TransferEditor& editor, ImageColorSpace space);
// Marks the value at the visible point under the pointer.
void draw_marker(const TransferFrame& frame, const TransferFunction& function, double value);
// Draws the colours of values between two corners.
void draw_color_strip(const TransferFrame& frame, const ImVec2& min, const ImVec2& max,
                      const TransferFunction& function, ImageColorSpace space);

// Text of a number for an axis: few digits, and an exponent only if that is shorter.
struct AxisText {
    char text[24];
};
AxisText axis_text(double number);

// Returns multiples of 1, 2 or 5 times a power of 10 from lo to hi, at most `most`.
std::vector<double> even_ticks(double lo, double hi, int most);

}  // namespace lamina::view
