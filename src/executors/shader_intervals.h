// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "lamina/transfer_function.h"
#include "optics/preintegration_table.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// Extinction times length must stay finite in float32; at this extinction everything is opaque.
inline constexpr double max_shader_extinction = 1e30;

// The transfer function over a volume's range as shaders read it (shaders/optics/intervals.glsl):
// intervals on which it is linear, over scalars normalised so that the range is [0, 1]. Laid out as
// a texture of 4 rows, one column an interval, RGBA: (left end, 1 / width, table node at the left
// end, table nodes to the right end), (colour, extinction) at the left end, the same at the right
// end, (what float32 leaves over of both extinctions).
struct ShaderIntervals {
    static constexpr int start_count = 1024;
    static constexpr int rows = 4;

    int count = 0;
    std::vector<float> texels;  // rows * count * 4
    // The interval in which each 1024th of [0, 1] begins: where to search from.
    std::array<float, start_count> starts{};
};

// At a step's very value the later side counts, and volumes of labels have whole regions there.
// What is sampled of them carries roundings of float32: its steps lie this much earlier.
inline constexpr double sampled_step_advance = 0x1p-22;

// `anchors`: of the pre-integration table that goes with it, or empty. `step_advance`: of scalars
// normalised to [0, 1].
ShaderIntervals make_intervals(const TransferFunction& transfer_function, const ValueRange& range,
                               const std::vector<PreintegrationTable::Anchor>& anchors,
                               double step_advance);

}  // namespace lamina
