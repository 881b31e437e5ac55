// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstdint>

#include "optics/segment_table.h"
#include "projection/tile_chunk.h"
#include "plan/project_plan.h"
#include "executors/tile_transfer.h"
#include "tiles/target_blend.h"
#include "tiles/tile_grid.h"
#include "tiles/tile_image.h"

namespace lamina {

// How a fragment reaches the target (shaders/projection/output.glsl).
enum class FragmentOutput {
    native,      // as a blending unit does it
    dithered,    // rounded to codes by chance first: ProjectDither::alpha
    stochastic,  // the result rounded by chance: ProjectDither::after_blend
    emulated     // as render.emulate says
};

// What the fragments of a frame know beside their records: shaders/projection/*.glsl's uniforms.
struct TetFragments {
    SegmentSource source;
    bool perspective, colored;
    bool divided;  // of triangles: what they interpolate is over z
    FragmentOutput output;
    std::uint32_t seed;
    TargetBlend blend;
    bool opacity_only = false;  // for a node of a tree (shaders/projection/tet.frag)
    float depth_scale = 1;      // of it: all parts over those of the leaf
    glm::vec2 image_middle;     // window coordinates
    int image_rows;
    float pixel_size;
    float near_depth;
    // For both ends of a run: squares of all depths are floats. Not for codes, which are those of
    // OpenGL's programs.
    bool one_division;
    glm::dvec3 tie_shift;
    glm::vec4 constant_optics;               // SegmentSource::constant
    glm::vec3 single_color;                  // where not colored
    const float* front_weights = nullptr;    // SegmentSource::parts, where colored
    const SegmentTable* table = nullptr;     // SegmentSource::table
    float inverse_first_length = 0;          // of it
    const TileTransfer* transfer = nullptr;  // SegmentSource::cut_table, ::analytic
};

// One tile of a frame. `slants`: of its pixels, at TileGrid::place(), world length per unit of z;
// null: 1.
struct TetTile {
    TileGrid::Tile area;
    const float* slants;
    TilePixels* pixels;
    TilePlane* opacity;  // where opacity_only: instead of the pixels
};

// Puts the parts of one chunk that the tile is to draw over its pixels; returns the number of
// fragments.
std::int64_t draw_tets(const TetFragments& fragments, const TileChunk& chunk,
                       const TileChunk::Parts& parts, const TetTile& tile);

// The same for everything that a plan may ask for; draw_tets() knows what is asked for most.
std::int64_t draw_general_tets(const TetFragments& fragments, const TileChunk& chunk,
                               const TileChunk::Parts& parts, const TetTile& tile);

}  // namespace lamina
