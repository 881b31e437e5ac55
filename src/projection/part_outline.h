// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "projection/tet_record.h"
#include "tiles/tile_grid.h"

namespace lamina {

// Which squares of TileGrid::block pixels a tet may cover: rays meet it where the depths on all its
// front faces are less than those on all its back faces, which is inside of three or four lines,
// its silhouette, on which two of them are equal. Each line bounds the first column of the squares
// in a row: `at_first` for squares whose first row is the area's, and `per_row` more for each row
// below; in pixels from the area's first column.
struct PartOutline {
    static constexpr float none = std::numeric_limits<float>::infinity();

    std::array<float, 4> at_first{none, none, none, none}, per_row{};
    std::uint8_t least = 0;  // a bit for each bound that is a least column; the others are greatest
};

// The pixels of a tet, rows from the top of the picture.
struct PixelArea {
    std::int32_t first_column, last_column, first_row, last_row;
};

// Of a tet with 1 to 3 front faces whose depths are found in float32. `image_rows`: of the picture.
PartOutline outline_of(const TetRecord& record, const PixelArea& area, int image_rows);

}  // namespace lamina
