// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "executors/lights.h"
#include "executors/transfer_tables.h"
#include "preintegration/preintegration_table.h"
#include "projection/cpu_batch.h"
#include "tiles/tile_image.h"

namespace lamina {

// How a fragment is written to the target (shaders/projection/output.glsl).
enum class FragmentOutput {
    native,      // blended as by a GPU's blending unit
    dithered,    // rounded to codes at random, then blended: ProjectDither::alpha
    stochastic,  // blended, then rounded at random: ProjectDither::after_blend
    emulated     // composited in codes, as render.emulate says
};

// Data of a frame's fragments beside their records: the uniforms of shaders/projection/*.glsl.
struct TetFragments {
    SegmentSource source;
    bool perspective, colored;
    bool divided;  // for triangles: their vertices' values are divided by z
    FragmentOutput output;
    std::uint32_t seed;
    TargetBlend blend;
    // Scalars of whole tets may lie outside [0, 1] (ProjectPlan::windowed).
    bool windowed = false;
    bool opacity_only = false;  // only opacity is drawn, as in leaves of a tree
    float depth_scale = 1;   // scales optical depth: number of all cell fragments / of the leaf's
    glm::vec2 image_middle;  // window coordinates
    int image_rows;
    float pixel_size;  // View::pixel, in the plan's unit of length
    float near_depth;  // depth (tet_record.h) of the near plane
    // True: both ends of a segment share one division, for which squares of depths must be finite
    // in float32. False for targets with codes, which must equal those of OpenGL's programs.
    bool shares_division;
    glm::dvec3 ray_perturbation;            // scene/camera.h
    glm::vec4 constant_optics;              // SegmentSource::constant
    glm::vec3 single_color;                 // if colored is false
    const float* front_weights = nullptr;   // SegmentSource::parts, if colored
    const UniformTable* table = nullptr;    // SegmentSource::table
    float inverse_first_length = 0;         // UniformTable::inverse_first_length()
    const CpuTransfer* transfer = nullptr;  // SegmentSource::cut_table, ::analytic
    // The members below are set if something is lit.
    const CpuLight* light = nullptr;  // directions in world axes
    float smallest_square = 0;        // smallest gradient squared, in GradientRecord's unit
    std::array<glm::vec3, 3> axes;    // unit vectors to the right, up and forward
    bool slanted = false;             // lengths along rays are longer than differences of z
};

// One tile of a frame. `number`: index in the TileGrid. `slants`: for each TileGrid::place(), the
// world length along the pixel's ray per unit of z; null if it is 1 for all pixels.
struct TetTile {
    std::size_t number;
    TileGrid::Tile area;
    const float* slants;
    TilePixels* pixels;
    TilePlane* opacity;  // used instead of `pixels` if opacity_only
};

// Draws the tile's cell fragments of a batch over its pixels; returns the number of fragments.
std::int64_t draw_tets(const TetFragments& fragments, const TileBatch& batch, const TetTile& tile);

// Draws with light; draw_tets() calls it if the batch is lit.
std::int64_t draw_lit_tets(const TetFragments& fragments, const TileBatch& batch,
                           const TetTile& tile);

// Draws with every source and output; draw_tets() calls it for all but the most frequent plan.
std::int64_t draw_general_tets(const TetFragments& fragments, const TileBatch& batch,
                               const TetTile& tile);

}  // namespace lamina
