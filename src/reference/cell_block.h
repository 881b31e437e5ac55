// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace lamina {

using CellIndex = std::array<std::int64_t, 3>;

// Neighbouring cells that a walk treats alike.
struct CellBlock {
    CellIndex first, last;
    bool hidden = false;                 // nothing is to be visited there
    const std::uint8_t* rows = nullptr;  // VisibleCells::may_show()

    bool holds(std::int64_t cell, int axis) const {
        return first[axis] <= cell && cell <= last[axis];
    }
};

}  // namespace lamina
