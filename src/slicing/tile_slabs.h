// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "executors/tile_light.h"
#include "executors/tile_transfer.h"
#include "facts/volume_facts.h"
#include "plan/plan.h"
#include "slicing/cell_map.h"
#include "slicing/slab_polygons.h"
#include "slicing/texture_bricks.h"
#include "slicing/tile_volume.h"

namespace lamina {

// Number of slabs in a block. The coordinates of a block are floats relative to its front.
inline constexpr int tile_block_slabs = 32;

// The viewing rays: the uniforms of shaders/slicing/ray.glsl. Points are in the index space of a
// brick, and depth counts from the nearest slab's front.
struct TileRays {
    glm::dvec3 origin_column{0}, origin_row{0};  // change per pixel to the right and downwards
    glm::dvec3 direction_middle{0}, direction_column{0}, direction_row{0};
    double middle_column = 0, middle_row = 0;  // of the image, in pixels
    double pixel_size = 0;                     // at depth 1; 0 if rays are parallel
    double slab_thickness = 0;
    int tested_slabs = 1;  // number of slabs that are tested together for being visible
    // Depths of the boundaries of a block's slabs and of the middles between them, from the block's
    // front on.
    std::array<float, tile_block_slabs + 1> edges{};
    std::array<float, tile_block_slabs> middles{};
};

struct TileBrickView {
    TileBrick brick;
    glm::dvec3 origin_middle{0};          // origin of the ray through the image's middle
    IndexBox box, drawn;                  // in the brick's index space
    glm::dvec3 last_face = no_last_face;  // of `box` (slicing/texture_bricks.h)
    std::vector<IndexPlane> clip;
    glm::dvec3 first{0};  // the volume's sample at the brick's origin
    double margin = 0;    // largest error of a point in float, in voxels
    // The box that holds the middles of the segments to draw, if slabs are drawn whole
    // (SlicePlan::share).
    std::optional<IndexBox> share;
};

// Everything that the segments of slabs depend on.
struct TileSlabs {
    const SlicePlan* plan = nullptr;
    const TileTransfer* transfer = nullptr;    // null if no scalar is fetched
    const OccupiedBricks* occupied = nullptr;  // null if all slabs are evaluated
    const ConstantBricks* constant = nullptr;  // null if constant bricks are not used
    // In place of both if rays are integrated cell by cell; otherwise null.
    const CellMap* cells = nullptr;
    const TileLight* light = nullptr;  // null if nothing is lit
    TileRays rays;
    std::vector<TileBrickView> bricks;  // visible bricks, in the plan's order
    std::array<float, 3> single_color{};
    double constant_extinction = 0;
    // Ranks of dithering, by slab modulo period.
    std::vector<std::uint32_t> alpha_ranks, color_ranks;
};

}  // namespace lamina
