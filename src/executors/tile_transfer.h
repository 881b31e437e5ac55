// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tbb/cache_aligned_allocator.h>

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "lamina/transfer_function.h"
#include "optics/preintegration_table.h"
#include "plan/table_plan.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// The transfer function as vectors look it up: ShaderIntervals, one array a component. Arrays end
// with copies of the last interval, so that a vector may be loaded from their beginning.
struct TileTransfer {
    static constexpr int few = 16;  // intervals that are found by comparisons

    // `range`: the scalars seen as [0, 1]; lo < hi. `table`: of the pre-integration, or null.
    // `step_advance`: see make_intervals().
    TileTransfer(const TransferFunction& transfer_function, const ValueRange& range,
                 const TablePlan* table, double step_advance);

    int intervals = 0;
    std::vector<float> end, inverse_width;     // left end, 1 / width
    std::vector<float> first_node, nodes;      // of the table: at the left end, to the right end
    std::array<std::vector<float>, 4> left;    // colour and extinction at the left end
    std::array<std::vector<float>, 4> change;  // to the right end
    std::vector<float> right_extinction;
    std::vector<float> left_rest, right_rest;  // what float leaves over of the extinctions
    std::vector<float> shown_before, shown;  // intervals with extinction before it; it itself: 0, 1
    std::vector<std::int32_t> starts;        // ShaderIntervals::starts

    std::shared_ptr<const PreintegrationTable> table;
    // Of a coloured table: emission and mean extinction, RGBA, the layers of a pair of scalars side
    // by side; aligned, so that two of them are in one line of the cache.
    using Texels = std::vector<float, tbb::cache_aligned_allocator<float>>;
    Texels texels;
    float layers_per_length = 0;

    std::int64_t byte_count() const;
};

}  // namespace lamina
