// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "reference/cut.h"
#include "reference/piece_batch.h"
#include "reference/transfer_intervals.h"

namespace lamina {

// Appends the pieces of the segments that are not transparent, front to back. It does not set
// `before`, nor the results.
// `error_per_length`: allowed to a channel of the ray.
void append_pieces(const SegmentBatch& segments, const TransferIntervals& transfer,
                   double error_per_length, PieceBatch& pieces);

}  // namespace lamina
