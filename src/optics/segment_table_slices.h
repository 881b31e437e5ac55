// SPDX-License-Identifier: Apache-2.0
// How the texels of a SegmentTable are computed, before they are rounded to the table's format.
#pragma once

#include <vector>

#include "lamina/transfer_function.h"
#include "optics/segment_table.h"

namespace lamina {

// The scalars of the nodes, from lo to hi.
std::vector<double> table_nodes(const SegmentTableRequest& request);

// Fills layers [0, layer_count) with the closed form of every segment.
void fill_exact(SegmentTable& table, const TransferFunction& transfer_function, int layer_count);

// Fills layers from `first_layer` >= 2 on, each from those of shorter segments.
void fill_incremental(SegmentTable& table, int first_layer);

}  // namespace lamina
