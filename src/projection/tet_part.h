// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace lamina {

// What is projected at a time: a tet, or the part of it on which the transfer function is linear.
struct TetPart {
    static constexpr std::int32_t whole = -1;

    std::int32_t tet;
    std::int32_t piece = whole;  // TetPieces::pieces
};

}  // namespace lamina
