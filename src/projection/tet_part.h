// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace lamina {

// What is projected at a time: a tet, or the part of it on which the transfer function is linear.
struct TetPart {
    static constexpr std::int32_t whole = -1;

    std::int32_t tet;
    std::int32_t piece = whole;  // TetPieces::pieces
};

// For dithering: of a part of one of `tets` tets.
inline std::uint32_t part_number(const TetPart& part, std::size_t tets) {
    return static_cast<std::uint32_t>(part.tet) +
           static_cast<std::uint32_t>(part.piece + 1) * static_cast<std::uint32_t>(tets);
}

}  // namespace lamina
