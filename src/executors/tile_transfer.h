// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tbb/cache_aligned_allocator.h>

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "lamina/transfer_function.h"
#include "preintegration/preintegration_table.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// The transfer function in the form that vectors look it up: ShaderIntervals with one array a
// component. Arrays end with copies of the last interval, so that a whole vector may be loaded from
// their beginning.
struct TileTransfer {
    static constexpr int few = 16;  // up to so many intervals are searched by comparisons

    // `range`: the scalars that become [0, 1]; lo < hi. `knot_table`: the pre-integration table, or
    // null. `step_advance`: see make_intervals(). `curved`: intervals are curves if points are
    // smooth (optics/curved_pieces.h); not with a table.
    TileTransfer(const TransferFunction& transfer_function, const ValueRange& range,
                 std::shared_ptr<const KnotTable> knot_table, double step_advance,
                 bool curved = false);

    int intervals = 0;
    std::vector<float> left_end, inverse_width;  // of each interval: where it begins, 1 / width
    // Nodes of the table: the one at the left end, and how many there are to the right end.
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
    // Number of intervals with extinction before it; and the scalar beyond which it has extinction
    // itself: -1 where it has some from its left end on, beyond all scalars where it has none.
    std::vector<float> shown_before, shown_beyond;
    std::vector<std::int32_t> starts;  // ShaderIntervals::starts

    // Numbers that are looked up of an interval together, in a line of the cache for each:
    // extinction at the left end, its change, left end, right end; 1 / width, colour at the left
    // end; its change, bend[0]; bend[1].
    static constexpr std::size_t record_size = 16;
    using Aligned = std::vector<float, tbb::cache_aligned_allocator<float>>;
    Aligned records;

    std::shared_ptr<const KnotTable> table;
    // The texels of a coloured table: emission and mean extinction as RGBA, and of a lit one behind
    // that its front parts. The layers of a pair of scalars lie side by side and are aligned, so
    // that two of them share a line of the cache.
    Aligned texels;
    float layers_per_length = 0;

    std::int64_t byte_count() const;
};

}  // namespace lamina
