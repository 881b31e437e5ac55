// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <imgui.h>

#include <algorithm>

#include "model/symlog_axis.h"

namespace lamina::view {

// Maps values and extinctions to the screen: values from `value_lo` to `value_hi` along x,
// extinctions along a symmetric-log axis up y.
struct TransferFrame {
    ImVec2 min, max;  // the corners of the curves' part
    double value_lo = 0, value_hi = 1;
    SymlogAxis axis{0, 1, .01};

    float width() const { return max.x - min.x; }
    float height() const { return max.y - min.y; }
    float x(double value) const {
        return min.x + width() * static_cast<float>((value - value_lo) / (value_hi - value_lo));
    }
    // Extinctions beyond the axis are at its end.
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

}  // namespace lamina::view
