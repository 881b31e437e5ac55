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

// Max extinction in shaders and vector code: opaque, and finite in float32 even times a length.
inline constexpr double max_shader_extinction = 1e30;
// Larger than all normalised scalars.
inline constexpr float beyond_all_scalars = 3e38f;

// The transfer function over a volume's range as shaders read it (shaders/optics/intervals.glsl):
// intervals on which it is linear, over scalars normalised so that the range is [0, 1]. It is a
// texture of 4 rows with one RGBA column for each interval. Row 0: left end; 1 / width; table node
// at the left end; number of table nodes up to the right end. Row 1: colour and extinction at the
// left end. Row 2: those at the right end. Row 3: the remainders of both extinctions that float32
// does not hold; the scalar up to which, from the left end on, nothing is visible; the right end,
// which for the last interval lies beyond all scalars.
struct ShaderIntervals {
    static constexpr int start_count = 1024;
    static constexpr int rows = 4;
    // Intervals side by side in a texture; more continue in the next four rows (intervals.glsl).
    static constexpr int columns = 4096;

    int count = 0;
    bool steps = false;         // colour or extinction jump between two intervals
    std::vector<float> texels;  // rows * count * 4
    // The intervals that hold the beginnings of equal parts of [0, 1], at which searches start.
    std::array<float, start_count> starts{};
};

// Distance in normalised scalars by which steps of the transfer function are moved down if scalars
// are sampled. At a step the later side counts; volumes of labels have large regions with exactly
// its value, and samples there are off by roundings of float32, up to this.
inline constexpr double sampled_step_advance = 0x1p-22;

// Makes intervals from a transfer function's pieces over a range, taking curved ones as straight.
// `anchors`: those of its pre-integration table, or empty. `step_advance`: distance by which steps
// are moved down, in normalised scalars.
ShaderIntervals make_intervals(const std::vector<CurvedPiece>& pieces, const ValueRange& range,
                               const std::vector<KnotTable::Anchor>& anchors, double step_advance);

// The transfer function in the form in which vector code looks it up: ShaderIntervals with one
// array for each component. Arrays end with copies of the last interval, so that a vector may be
// loaded from their beginning.
struct CpuTransfer {
    static constexpr int few = 16;  // largest number of intervals that are searched by comparisons

    // `range`: the scalars that are normalised to [0, 1]; lo < hi. `knot_table`: the
    // pre-integration table, or null. `step_advance`: see make_intervals(). `curved`: intervals are
    // curved if points are smooth (optics/pieces.h); not allowed with a table.
    CpuTransfer(const TransferFunction& transfer_function, const ValueRange& range,
                std::shared_ptr<const KnotTable> knot_table, double step_advance,
                bool curved = false);

    int intervals = 0;
    bool steps = false;                          // ShaderIntervals::steps
    std::vector<float> left_end, inverse_width;  // for each interval: left end, 1 / width
    // Table node at the left end of each interval, and number of table nodes up to its right end.
    std::vector<float> first_node, nodes;
    std::array<std::vector<float>, 4> left;    // colour and extinction at the left end
    std::array<std::vector<float>, 4> change;  // from the left end to the right end
    std::vector<float> right_extinction;
    // Bends of curved intervals, empty if all are straight. At share u of the interval the
    // extinction is that of the straight line plus u (1 - u) (bend[0] + u bend[1]).
    std::array<std::vector<float>, 2> bend;
    std::vector<float> right_end;              // of the last interval: beyond all scalars
    std::vector<float> left_rest, right_rest;  // remainders of extinctions beyond float
    // shown_before: number of earlier intervals with extinction; shown_beyond: scalar beyond which
    // the interval has extinction: -1 if already at its left end, beyond_all_scalars if nowhere.
    std::vector<float> shown_before, shown_beyond;
    std::vector<std::int32_t> starts;  // ShaderIntervals::starts

    // A record for each interval, the numbers that are looked up together, in a cache line of its
    // own: extinction at the left end, its change, left end, right end; 1 / width, colour at the
    // left end; change of colour, bend[0]; bend[1].
    static constexpr std::size_t record_size = 16;
    using Aligned = std::vector<float, tbb::cache_aligned_allocator<float>>;
    Aligned records;

    std::shared_ptr<const KnotTable> table;
    // Texels of a coloured table: emission and mean extinction as RGBA, then the front parts if the
    // table is lit. The layers of a pair of scalars lie side by side and are aligned, so that two
    // neighbouring layers share a cache line.
    Aligned texels;
    float layers_per_length = 0;

    std::int64_t byte_count() const;
};

}  // namespace lamina
