// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace lamina {

// A cell fragment: the region of a tet on which the transfer function is linear, or the whole tet.
// Cell fragments are projected one by one.
struct TetPart {
    static constexpr std::int32_t whole = -1;

    std::int32_t tet;
    std::int32_t piece = whole;  // index into TetPieces::pieces()
};

// A number of its own for each cell fragment of a mesh of `tets` tets, for dithering.
inline std::uint32_t part_number(const TetPart& part, std::size_t tets) {
    return static_cast<std::uint32_t>(part.tet) +
           static_cast<std::uint32_t>(part.piece + 1) * static_cast<std::uint32_t>(tets);
}

}  // namespace lamina
