// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tbb/cache_aligned_allocator.h>
#include <array>
#include <cstdint>
#include <memory>
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

// Makes intervals of pieces over a range, as straight ones. `anchors`: those of the pre-integration
// table that goes with it, or empty. `step_advance`: distance by which steps lie earlier, in
// scalars normalised to [0, 1].
ShaderIntervals make_intervals(const std::vector<CurvedPiece>& pieces, const ValueRange& range,
                               const std::vector<KnotTable::Anchor>& anchors, double step_advance);

// The transfer function in the form in which vectors look it up: ShaderIntervals with one array a
// component. Arrays end with copies of the last interval, so that a whole vector may be loaded from
// their beginning.
struct CpuTransfer {
    static constexpr int few = 16;  // largest number of intervals that are searched by comparisons

    // `range`: the scalars that become [0, 1]; lo < hi. `knot_table`: the pre-integration table, or
    // null. `step_advance`: see make_intervals(). `curved`: intervals are curves if points are
    // smooth (optics/pieces.h); not with a table.
    CpuTransfer(const TransferFunction& transfer_function, const ValueRange& range,
                std::shared_ptr<const KnotTable> knot_table, double step_advance,
                bool curved = false);

    int intervals = 0;
    std::vector<float> left_end, inverse_width;  // for each interval: its beginning, 1 / width
    // Table nodes of each interval: the one at the left end, and their number to the right end.
    std::vector<float> first_node, nodes;
    std::array<std::vector<float>, 4> left;    // colour and extinction at the left end
    std::array<std::vector<float>, 4> change;  // from the left end to the right end
    std::vector<float> right_extinction;
    // Bends of curves, empty if all intervals are straight: at the share u of the way the
    // extinction is that of the straight line plus u (1 - u) (bend[0] + u bend[1]).
    std::array<std::vector<float>, 2> bend;
    std::vector<float> right_end;  // of the last interval: beyond all scalars
    // Remainders of the extinctions that float does not hold.
    std::vector<float> left_rest, right_rest;
    // For each interval the number of intervals with extinction before it; and the scalar beyond
    // which it has extinction itself: -1 if it has some from its left end on, beyond all scalars if
    // it has none.
    std::vector<float> shown_before, shown_beyond;
    std::vector<std::int32_t> starts;  // ShaderIntervals::starts

    // Numbers of an interval that are looked up together, in a cache line of their own: extinction
    // at the left end, its change, left end, right end; 1 / width, colour at the left end; its
    // change, bend[0]; bend[1].
    static constexpr std::size_t record_size = 16;
    using Aligned = std::vector<float, tbb::cache_aligned_allocator<float>>;
    Aligned records;

    std::shared_ptr<const KnotTable> table;
    // Texels of a coloured table: emission and mean extinction as RGBA, followed by the front parts
    // if the table is lit. The layers of a pair of scalars lie side by side and are aligned, so
    // that two of them share a cache line.
    Aligned texels;
    float layers_per_length = 0;

    std::int64_t byte_count() const;
};

}  // namespace lamina
