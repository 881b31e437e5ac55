// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "annotation/layout.h"

namespace lamina {

// The part of a transfer function that a colour bar shows.
struct BarRange {
    double lo = 0, hi = 0;  // values; equal if there is a single one
};

// Returns the range of the data's values that show, the least to the largest with extinction above
// 0, without those beyond the function's ends, which look alike; all if none shows.
BarRange bar_range(const TransferFunction& transfer_function, const ValueRange& data);

// Returns the value in the middle of a row of pixels of a bar of `rows` rows; row 0 is the topmost.
double value_at(const BarRange& range, int row, int rows);

struct ColorBar {
    Block block;
    Rectangle colors;  // where the function's colours are, from the block's upper left corner
    BarRange range;
    std::vector<double> ticks;  // rows of the numbers, from the block's top, upwards
};

// Makes a block: the caption, the function's colours over the values that show, its opacity beside
// them, and numbers. `wanted`: scene.annotations.colorbar; `height`: what other blocks leave to it,
// in pixels; it shrinks to half of its own height for them.
ColorBar color_bar(Pen& pen, const Annotation& wanted, const Scene& scene,
                   const AnnotatedData& data, double height);

// Makes a block of a swatch and a name for each label that shows (label_legend.cpp), in this height
// if at least two lines fit into it. Warns if there is no room for all of them.
Block label_legend(Pen& pen, const Annotation& wanted, const Scene& scene,
                   const AnnotatedData& data, double height);

}  // namespace lamina
