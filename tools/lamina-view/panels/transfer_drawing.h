// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "lamina/image_color_space.h"
#include "lamina/value_histogram.h"
#include "model/transfer_editor.h"
#include "panels/transfer_frame.h"

namespace lamina::view {

// Returns a colour of a scene as the screen shows it.
ImU32 screen_color(const glm::dvec3& color, ImageColorSpace space, float opacity = 1);

// Draw parts of the plot, in ImGui's current window.
void draw_histogram(const TransferFrame& frame, const ValueHistogram& histogram);
void draw_extinction_axis(const TransferFrame& frame);  // on the left
// The axis on the right, of opacities over `unit_length`.
void draw_opacity_axis(const TransferFrame& frame, double unit_length);
void draw_value_axis(const TransferFrame& frame);  // below
// The curve of extinction, over the colours of its values.
void draw_curve(const TransferFrame& frame, const TransferFunction& function,
                ImageColorSpace space);
void draw_handles(const TransferFrame& frame, const TransferEditor& editor, ImageColorSpace space);
// The value that is seen under the pointer.
void draw_marker(const TransferFrame& frame, const TransferFunction& function, double value);
// The colours of values between two corners.
void draw_color_strip(const TransferFrame& frame, const ImVec2& min, const ImVec2& max,
                      const TransferFunction& function, ImageColorSpace space);

// Writes a number for an axis: with few digits, and with an exponent only if that is shorter.
struct AxisText {
    char text[24];
};
AxisText axis_text(double number);

// Returns numbers of 1, 2 or 5 times a power of 10 between two others, `most` at most.
std::vector<double> even_ticks(double lo, double hi, int most);

}  // namespace lamina::view
