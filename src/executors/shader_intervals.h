// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "lamina/transfer_function.h"
#include "optics/pieces.h"
#include "preintegration/preintegration_table.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// The largest extinction in shaders. Extinction times length must stay finite in float32, and with
// this extinction everything is opaque.
inline constexpr double max_shader_extinction = 1e30;
// Larger than all normalised scalars.
inline constexpr float beyond_all_scalars = 3e38f;

// The transfer function over a volume's range as shaders read it (shaders/optics/intervals.glsl).
// It consists of intervals on which it is linear, over scalars normalised so that the range is [0,
// 1]. It is laid out as a texture of 4 rows with one RGBA column an interval. Row 0: left end, 1 /
// width, table node at the left end, number of table nodes to the right end. Row 1: colour and
// extinction at the left end. Row 2: those at the right end. Row 3: the remainders of both
// extinctions that float32 does not hold; the scalar up to which, from the left end on, nothing is
// visible; the right end, which for the last interval lies beyond all scalars.
struct ShaderIntervals {
    static constexpr int start_count = 1024;
    static constexpr int rows = 4;

    int count = 0;
    std::vector<float> texels;  // rows * count * 4
    // For each of 1024 equal parts of [0, 1] the interval in which it begins, as a start for
    // searches.
    std::array<float, start_count> starts{};
};

// Distance, in scalars normalised to [0, 1], by which steps of the transfer function lie earlier if
// scalars are sampled: these carry rounding errors of float32. At the value of a step the later
// side counts, and volumes of labels have whole regions with that value.
inline constexpr double sampled_step_advance = 0x1p-22;

// `anchors`: those of the pre-integration table that goes with it, or empty. `step_advance`:
// distance by which steps lie earlier, in scalars normalised to [0, 1].
ShaderIntervals make_intervals(const TransferFunction& transfer_function, const ValueRange& range,
                               const std::vector<KnotTable::Anchor>& anchors, double step_advance);
// Makes intervals of the pieces over that range, as straight ones.
ShaderIntervals make_intervals(const std::vector<CurvedPiece>& pieces, const ValueRange& range,
                               const std::vector<KnotTable::Anchor>& anchors, double step_advance);

}  // namespace lamina
