// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>

#include "projection/part_outline.h"

namespace lamina {

// A bound on the optical depth of any run through a cell fragment, on which the cost of its colour
// depends. thin: at most thin_depth; faint: at most faint_depth (optics/front_weights.h).
enum class PartDepth : std::uint8_t { any, thin, faint };

// The pixels that a cell fragment may cover: columns from the left, rows from the top of the
// picture.
struct alignas(64) PartArea : PixelArea {
    bool careful;     // depths on its faces are found in double precision (FragmentKind::careful)
    PartDepth depth;  // bound for any run through it
    // Outside a tet the planes of its faces meet at any depth, and there rounding alone may make
    // runs that can be seen. Where this is true, pixels outside these columns and rows do not
    // count, and no run ends beyond `farthest`, a depth relative to the record's center.
    bool bounded = true;
    float farthest = std::numeric_limits<float>::infinity();
    PartOutline outline = {};
};

}  // namespace lamina
