// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace lamina {

// A pre-integration table whose nodes are aligned with the transfer function's points
// (optics/preintegration_table.h).
struct TablePlan {
    int scalar_nodes = 256;
    int length_layers = 1;
    double max_length = 0;  // in the plan's units
    bool colored = true;
    bool lit = false;  // with front parts (optics/front_parts.h)
    double error = 0;  // found error that it adds to the picture, in 1/255

    friend bool operator==(const TablePlan&, const TablePlan&) = default;
};

}  // namespace lamina
