// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "projection/tet_record.h"
#include "scene/camera.h"
#include "tiles/tile_image.h"

namespace lamina {

// The squares of TileGrid::block pixels that a tet may cover. Rays meet the tet if the depths on
// all its front faces are less than those on all its back faces. That region lies inside three or
// four lines, the silhouette, on which a front and a back depth are equal. Each line bounds the
// first column of the squares in a row: by `at_first` for squares whose first row is the area's
// first row, and by `per_row` more for each row below. Columns are in pixels from the area's first
// column.
struct PartOutline {
    static constexpr float none = std::numeric_limits<float>::infinity();

    std::array<float, 4> at_first{none, none, none, none}, per_row{};
    // A bit for each bound that is a least column; the other bounds are greatest columns.
    std::uint8_t least = 0;
};

// A bound on the optical depth of any segment through a cell fragment, on which the cost of its
// colour depends. thin: at most thin_depth; faint: at most faint_depth (optics/segment_integral.h).
enum class PartDepth : std::uint8_t { any, thin, faint };

// The pixels that a cell fragment may cover: columns from the left, rows from the top of the
// picture.
struct alignas(64) PartArea : PixelArea {
    bool careful;     // depths on its faces are found in double precision (FragmentKind::careful)
    PartDepth depth;  // bound for any segment through it
    // True: pixels outside these columns and rows do not count, and no segment ends beyond
    // `farthest`, a depth relative to the record's center. Outside a tet the planes of its faces
    // meet at any depth, and there rounding alone may make visible segments.
    bool bounded = true;
    float farthest = std::numeric_limits<float>::infinity();
    PartOutline outline = {};
};

// Returns the outline of a tet with 1 to 3 front faces whose depths are found in float32.
// `image_rows`: number of rows of the picture.
PartOutline outline_of(const SilhouetteRecord& record, const PixelArea& area, int image_rows);

}  // namespace lamina
