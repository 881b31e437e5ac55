// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/attempt.h"

namespace lamina::view {

// Cells of a table's row, from the next column on: expected error, Linf, L2, the share of the
// pixels that these are measured on, and ms of a frame. Empty if nothing is known.
void error_and_time_cells(const Attempt& attempt);
// Their columns.
void error_and_time_columns();

}  // namespace lamina::view
