// SPDX-License-Identifier: Apache-2.0
// Opacity by a word: a curve over the values that show, or a colour map's own opacities; and
// presets, which are colours, opacity and light in one word (docs/first-picture.md).
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lamina/color.h"
#include "lamina/transfer_function.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// A curve of extinction over the values that show, which run from t = 0 to t = 1. The formulas are
// those of pyvista's presets of these names.
struct OpacityCurve {
    enum class Form { linear, geom, sigmoid, foreground, points, of_colormap };
    struct Point {
        double t, share;
    };

    Form form = Form::linear;
    bool reversed = false;
    double steepness = 10;        // of a sigmoid
    std::vector<Point> points{};  // of the form `points`: straight lines, from t = 0 to t = 1
    // Values of t = 0 and t = 1 if the points have values of their own; the function is constant
    // outside.
    std::optional<ValueRange> range{};

    // Returns the extinction at t, as a share of the largest; the form must not be of_colormap.
    double at(double t) const;
};

// Returns the curve of a word: linear, geom, sigmoid, sigmoid_N, foreground; the first two also
// with _r, which reverses them; or of two or more numbers from 0 to 1, not all 0: "0,.2,.9" spread
// evenly, or "10:0,20:.5" at rising values. Throws Error that says what is expected of other words:
// "numbers from 0 to 1, found 2".
OpacityCurve opacity_curve(const std::string& word);

// Returns the values from the first to the last that the function shows; all of its points' values
// if it shows none.
ValueRange shown_range(const TransferFunction& transfer_function);

// Returns the function with the curve's extinction over `range`, and 0 below. Above, extinction is
// that at the end, or 0 if the function itself shows nothing there. Straight pieces follow the
// curve within a thousandth of its largest extinction.
TransferFunction with_opacity(const TransferFunction& transfer_function, const OpacityCurve& curve,
                              const ValueRange& range);

// Returns the function with the opacities of a colour map (over a unit length, as extinctions).
TransferFunction with_opacity_of(const TransferFunction& transfer_function,
                                 const Colormap& colormap);

// Colours, opacity and light that suit a kind of data. Empty: as they are.
struct Preset {
    const char* name;
    const char* colormap;
    const char* opacity;  // "colormap": the map's own
    const char* light;
};

std::span<const Preset> presets();

// Says why data of this range cannot be in HU, or that the colour map `name` shows none of them,
// and what helps. Nothing if they can.
std::optional<std::string> mistake_in_hounsfield_units(const ValueRange& range,
                                                       const Colormap& colormap,
                                                       const std::string& name);

}  // namespace lamina
