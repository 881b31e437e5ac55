// SPDX-License-Identifier: Apache-2.0
// The pre-integration tables of a plan: the numbers that they are built from, and the tables, which
// renderers look up as they are. A table follows from its numbers, the plan's range of scalars and
// the transfer function, so plans are compared by the numbers alone.
#pragma once

#include <memory>

#include "optics/preintegration_table.h"
#include "optics/segment_table.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// Numbers of a table whose nodes are aligned with the transfer function's points
// (optics/preintegration_table.h).
struct TableNumbers {
    int scalar_nodes = 256;
    int length_layers = 1;
    double max_length = 0;  // in the plan's units
    bool colored = true;
    bool lit = false;  // with front parts (optics/front_parts.h)
    double error = 0;  // found error that it adds to the picture, in 1/255

    // A single layer does not depend on the longest segment: views that differ in that share a
    // table.
    PreintegrationRequest request(const ValueRange& range) const {
        const double longest = length_layers > 1 ? max_length : 0;
        return {range.lo, range.hi, longest, scalar_nodes, length_layers, colored, lit};
    }

    friend bool operator==(const TableNumbers&, const TableNumbers&) = default;
};

struct TablePlan : TableNumbers {
    std::shared_ptr<const PreintegrationTable> built = nullptr;  // null if nothing looks it up
};

// A table with equally spaced scalars (optics/segment_table.h).
struct SegmentTablePlan : SegmentTableRequest {
    std::shared_ptr<const SegmentTable> built = nullptr;  // null if nothing looks it up
};

}  // namespace lamina
