// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "compositing/tree_shape.h"
#include "slicing/tile_slabs.h"
#include "tiles/target_blend.h"
#include "tiles/tile_image.h"

namespace lamina {

// Replaces a tile by the picture of a tree whose nodes are computed in float (docs/numerics.md,
// section 4). If the root is a leaf, slabs are composited one after the other in registers. Each
// vector of pixels goes through the whole tree by itself, nearest slab first. Returns the number of
// segments that were evaluated.
std::int64_t march_tile(const TileSlabs& slabs, const TreeShape& shape, const TileGrid::Tile& area,
                        TilePixels& pixels);

// Composites all slabs onto a tile one after the other, in the plan's order. Returns the number of
// segments that were evaluated, as does the next function.
std::int64_t blend_tile(const TileSlabs& slabs, const TargetBlend& blend,
                        const TileGrid::Tile& area, TilePixels& pixels);

// Composites the opacity alone of some slabs onto one channel: a leaf of a tree of fixed-point
// nodes. Optical depths are multiplied by `depth_scale`.
std::int64_t blend_tile_opacity(const TileSlabs& slabs, const TargetBlend& blend,
                                const TileGrid::Tile& area, const SampleSpan& span,
                                double depth_scale, TilePixels::Plane& opacity);

}  // namespace lamina
