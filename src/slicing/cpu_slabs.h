// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cassert>

#include "base/memory.h"
#include "executors/lights.h"
#include "executors/transfer_tables.h"
#include "facts/bricks.h"
#include "simd/target.h"
#include "slicing/cpu_volume.h"
#include "slicing/slab_geometry.h"

namespace lamina {

// The way in which rays that walk from cell to cell pass the bricks of a volume (MinMaxBricks).
// Kind 0: cell by cell. Kind r from 1 to 63: the cube of 2 r - 1 bricks around this one shows
// nothing, and rays cross it in one step. Kind constant + r: the cube has one colour and one
// extinction.
struct CellMap {
    static constexpr int constant = 128, farthest = OccupiedBricks::farthest;

    std::array<std::int64_t, 3> count{};  // bricks along each axis
    // One byte a brick, x fastest. Empty if all bricks are of kind 0. They may be the distances of
    // OccupiedBricks themselves, which nothing changes once they are measured.
    SparseBytes kinds;
};

// `occupied`, `varied` (ConstantBricks): of the same bricks; null if they are not used.
CellMap make_cell_map(const OccupiedBricks* occupied, const OccupiedBricks* varied);

// Number of slabs in a block. The coordinates of a block are floats relative to its front.
inline constexpr int block_slabs = 32;

// The viewing rays: the uniforms of shaders/slicing/ray.glsl. Points are in the index space of a
// brick, and depth counts from the nearest slab's front.
struct CpuRays {
    glm::dvec3 origin_column{0}, origin_row{0};  // change per pixel to the right and downwards
    glm::dvec3 direction_middle{0}, direction_column{0}, direction_row{0};
    double middle_column = 0, middle_row = 0;  // of the image, in pixels
    double pixel_size = 0;                     // at depth 1; 0 if rays are parallel
    double slab_thickness = 0;
    int tested_slabs = 1;  // number of slabs that are tested together for being visible
    // Depths of the boundaries of a block's slabs and of the middles between them, from the block's
    // front on.
    std::array<float, block_slabs + 1> edges{};
    std::array<float, block_slabs> middles{};
};

struct CpuBrickView {
    CpuBrick brick;
    glm::dvec3 origin_middle{0};          // origin of the ray through the image's middle
    IndexBox box, drawn;                  // in the brick's index space
    glm::dvec3 last_face = no_last_face;  // of `box` (slicing/slab_geometry.h)
    std::vector<IndexPlane> clip;
    glm::dvec3 first{0};  // the volume's sample at the brick's origin
    double margin = 0;    // largest error of a point in float, in voxels
    // The box that holds the middles of the segments to draw, if slabs are drawn whole
    // (SlicePlan::share).
    std::optional<IndexBox> share;
};

// Everything that the segments of slabs depend on.
struct CpuSlabs {
    const SlicePlan* plan = nullptr;
    const CpuTransfer* transfer = nullptr;     // null if no scalar is fetched
    const OccupiedBricks* occupied = nullptr;  // null if all slabs are evaluated
    const ConstantBricks* constant = nullptr;  // null if constant bricks are not used
    // In place of both if rays are integrated cell by cell; otherwise null.
    const CellMap* cells = nullptr;
    const CpuLight* light = nullptr;  // null if nothing is lit
    CpuRays rays;
    std::vector<CpuBrickView> bricks;  // visible bricks, in the plan's order
    std::array<float, 3> single_color{};
    double constant_extinction = 0;
    // Ranks of dithering, by slab modulo period.
    std::vector<std::uint32_t> alpha_ranks, color_ranks;
};

// A set of slabs of a block. Bit i stands for slab i; slab 0 is the nearest.
using BlockMask = std::uint32_t;
static_assert(block_slabs == 32);

// Returns the set of slabs first .. end - 1.
inline BlockMask block_mask(int first, int end) {
    if (first >= end) return 0;
    return ~BlockMask{0} >> (block_slabs - (end - first)) << first;
}

// Calls body(first, end) for each run of bits; the first function begins with the lowest run, the
// second with the highest.
template <class Body>
LAMINA_INLINE void for_each_run(BlockMask mask, const Body& body) {
    while (mask != 0) {
        const int first = std::countr_zero(mask);
        const int end = first + std::countr_one(mask >> first);
        body(first, end);
        mask &= ~block_mask(first, end);
    }
}

template <class Body>
LAMINA_INLINE void for_each_run_backwards(BlockMask mask, const Body& body) {
    while (mask != 0) {
        const int end = block_slabs - std::countl_zero(mask);
        const int first = end - std::countl_one(mask << (block_slabs - end));
        body(first, end);
        mask &= ~block_mask(first, end);
    }
}

// A set of slabs, of up to max_slabs, stored in blocks.
class SlabMask {
  public:
    void clear(int slabs) {
        assert(slabs <= max_slabs);
        std::fill_n(blocks_.begin(), (slabs + block_slabs - 1) / block_slabs, BlockMask{0});
    }
    void set(int first, int end) {
        while (first < end) {
            const int block = first / block_slabs, begin = block * block_slabs;
            const int block_end = std::min(end, begin + block_slabs);
            blocks_[static_cast<std::size_t>(block)] |=
                block_mask(first - begin, block_end - begin);
            first = block_end;
        }
    }
    BlockMask block(int number) const { return blocks_[static_cast<std::size_t>(number)]; }

  private:
    // Only the blocks that were cleared are defined.
    std::array<BlockMask, max_slabs / block_slabs> blocks_;
};

// Bounds on the rays of a square of pixels: on each axis they run between two straight lines.
class CpuBounds {
  public:
    CpuBounds() = default;
    // `column`, `row`: the first of edge x edge pixels.
    CpuBounds(const CpuRays& rays, const CpuBrickView& brick, int column, int row, int edge);

    // Calls found(first, end) for runs of slabs among first .. end - 1, nearest first. In slabs
    // outside these runs no ray comes near an occupied brick.
    template <class Found>
    void for_each_shown(const OccupiedBricks& bricks, const CpuRays& rays, int first, int end,
                        const Found& found) const {
        while (first < end) {
            const Stretch stretch = next_stretch(bricks, rays, first, end);
            if (stretch.shown) found(first, stretch.end);
            first = stretch.end;
        }
    }

    // Returns the point of the middle ray at a depth, in the volume's index space.
    glm::dvec3 middle_at(double depth) const { return middle_ + depth * middle_change_; }

  private:
    struct Stretch {
        int end;  // slab
        bool shown;
    };
    Stretch next_stretch(const OccupiedBricks& bricks, const CpuRays& rays, int first,
                         int end) const;
    bool shows(const OccupiedBricks& bricks, const CpuRays& rays, int first, int end) const;

    // The middle ray in the volume's index space, as a linear function of depth from the nearest
    // slab's front on.
    glm::dvec3 middle_{0}, middle_change_{0};
    // Largest distance from the middle ray, including the error of points.
    glm::dvec3 reach_{0}, reach_change_{0};
};

// Replaces a tile by the picture of a tree whose nodes are computed in float (docs/numerics.md,
// section 4). If the root is a leaf, slabs are composited one after the other in registers. Each
// vector of pixels goes through the whole tree by itself, nearest slab first. Returns the number of
// segments that were evaluated.
std::int64_t march_tile(const CpuSlabs& slabs, const TreeShape& shape, const TileGrid::Tile& area,
                        TilePixels& pixels);

// Composites all slabs onto a tile one after the other, in the plan's order. Returns the number of
// segments that were evaluated, as does the next function.
std::int64_t blend_tile(const CpuSlabs& slabs, const TargetBlend& blend, const TileGrid::Tile& area,
                        TilePixels& pixels);

// Composites the opacity alone of some slabs onto one channel: a leaf of a tree of fixed-point
// nodes. Optical depths are multiplied by `depth_scale`.
std::int64_t blend_tile_opacity(const CpuSlabs& slabs, const TargetBlend& blend,
                                const TileGrid::Tile& area, const SampleSpan& span,
                                double depth_scale, TilePixels::Plane& opacity);

}  // namespace lamina
