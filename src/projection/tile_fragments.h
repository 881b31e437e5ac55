// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstdint>

#include "projection/tile_chunk.h"
#include "scene/project_plan.h"
#include "tiles/target_blend.h"
#include "tiles/tile_grid.h"
#include "tiles/tile_image.h"

namespace lamina {

// What the fragments of a frame know beside their records: shaders/projection/*.glsl's uniforms.
struct TetFragments {
    SegmentSource source;
    bool perspective, colored;
    ProjectDither dither;
    bool in_codes;
    std::uint32_t seed;
    TargetBlend blend;
    glm::vec2 image_middle;  // window coordinates
    int image_rows;
    float pixel_size;
    float near_depth;
    bool squares_in_range;  // of all depths, in floats
    glm::dvec3 tie_shift;
    glm::vec4 constant_optics;             // SegmentSource::constant
    glm::vec3 single_color;                // where not colored
    const float* front_weights = nullptr;  // SegmentSource::parts, where colored
};

// One tile of a frame. `slants`: of its pixels, at TileGrid::place(), world length per unit of z;
// null: 1.
struct TetTile {
    TileGrid::Tile area;
    const float* slants;
    TilePixels& pixels;
};

// Puts the parts of one chunk that the tile is to draw over its pixels; returns the number of
// fragments.
std::int64_t draw_tets(const TetFragments& fragments, const TileChunk& chunk,
                       const TileChunk::Parts& parts, const TetTile& tile);

}  // namespace lamina
