// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

namespace lamina {

// Cell i of an axis lies between samples i and i+1. On `cell` axes the cells -1 and size-1 are the
// half voxels outside the samples.
using CellIndex = std::array<std::int64_t, 3>;

}  // namespace lamina
