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

// How far a ray may leap in each min/max brick (MinMaxBricks). Kind 0: it goes cell by cell. Kind
// r, 1 to 63: bricks whose numbers differ from its own by less than r on every axis show nothing:
// the ray crosses this cube in one step. Kind constant + r: the cube has one colour and one
// extinction.
struct CellMap {
    static constexpr int constant = 128, farthest = OccupiedBricks::farthest;

    std::array<std::int64_t, 3> count{};  // bricks along each axis
    // Kinds of bricks, x fastest; empty if all are 0. May share memory of OccupiedBricks::distance.
    SparseBytes kinds;
};

// `occupied`: null if rays do not leap over empty bricks; `varied`: null if not over constant ones.
CellMap make_cell_map(const OccupiedBricks* occupied, const OccupiedBricks* varied);

// Number of slabs in a block: the bits of BlockMask. A block's depths are floats from its front on.
inline constexpr int block_slabs = 32;

// The viewing rays of all pixels, as the uniforms of shaders/slicing/ray.glsl: points in a brick's
// index space, directions in voxels per depth, and depths from the front of the nearest slab on.
struct CpuRays {
    glm::dvec3 origin_column{0}, origin_row{0};  // change per pixel to the right and downwards
    glm::dvec3 direction_middle{0}, direction_column{0}, direction_row{0};
    double middle_column = 0, middle_row = 0;  // middle of the image, in pixels
    double pixel_size = 0;                     // width at depth 1; 0 if rays are parallel
    double slab_thickness = 0;
    int tested_slabs = 1;  // slabs whose visibility is tested together
    // Depths of a block's boundaries and of its slabs' middles, counted from its front.
    std::array<float, block_slabs + 1> edges{};
    std::array<float, block_slabs> middles{};
};

// A brick of the plan as one view sees it.
struct CpuBrickView {
    CpuBrick brick;
    glm::dvec3 origin_middle{0};          // origin of the ray through the image's middle
    IndexBox box, drawn;                  // the brick and its drawn part, in its index space
    glm::dvec3 last_face = no_last_face;  // of `box` (slicing/slab_geometry.h)
    std::vector<IndexPlane> clip;
    glm::dvec3 first{0};  // the volume's sample at the brick's origin
    double margin = 0;    // largest error of a point in float, in voxels
    // Set if slabs are drawn for a SlicePlan::share: only segments whose middles lie in it show.
    std::optional<IndexBox> share;
};

// Everything that the tiles of a frame depend on.
struct CpuSlabs {
    const SlicePlan* plan = nullptr;
    const CpuTransfer* transfer = nullptr;     // null if no scalar is fetched
    const OccupiedBricks* occupied = nullptr;  // null if all slabs are evaluated
    const ConstantBricks* constant = nullptr;  // null if constant bricks are not used
    // Replaces `occupied` and `constant` if rays are integrated cell by cell; otherwise null.
    const CellMap* cells = nullptr;
    const CpuLight* light = nullptr;  // null if nothing is lit
    CpuRays rays;
    std::vector<CpuBrickView> bricks;  // visible bricks, in the plan's order
    std::array<float, 3> single_color{};
    double constant_extinction = 0;
    // Ranks of dithering along depth (compositing/codes.h), by slab modulo period.
    std::vector<std::uint32_t> alpha_ranks, color_ranks;
};

// A set of slabs of a block. Bit i stands for slab i; slab 0 is the nearest.
using BlockMask = std::uint32_t;
static_assert(block_slabs == 32);

inline BlockMask block_mask(int first, int end) {
    if (first >= end) return 0;
    return ~BlockMask{0} >> (block_slabs - (end - first)) << first;
}

// Calls body(first, end) for each range of consecutive bits first .. end - 1, lowest range first.
template <class Body>
LAMINA_INLINE void for_each_range(BlockMask mask, const Body& body) {
    while (mask != 0) {
        const int first = std::countr_zero(mask);
        const int end = first + std::countr_one(mask >> first);
        body(first, end);
        mask &= ~block_mask(first, end);
    }
}

// Calls body(first, end) for each range of consecutive bits first .. end - 1, highest range first.
template <class Body>
LAMINA_INLINE void for_each_range_backwards(BlockMask mask, const Body& body) {
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
    // Only blocks that clear() has set have a value.
    std::array<BlockMask, max_slabs / block_slabs> blocks_;
};

// Bounds on the rays of a square of pixels: on each axis all of them lie, at every depth, within a
// distance of the middle ray that is linear in depth. They find slabs that no ray needs.
class CpuBounds {
  public:
    CpuBounds() = default;
    // `column`, `row`: the first of edge x edge pixels.
    CpuBounds(const CpuRays& rays, const CpuBrickView& brick, int column, int row, int edge);

    // Calls found(first, end) for ranges of slabs among first .. end - 1 in which a ray may come
    // near an occupied brick, nearest first.
    template <class Found>
    void for_each_shown(const OccupiedBricks& bricks, const CpuRays& rays, int first, int end,
                        const Found& found) const {
        while (first < end) {
            const SlabRange range = next_range(bricks, rays, first, end);
            if (range.shown) found(first, range.end);
            first = range.end;
        }
    }

    // Returns the point of the middle ray at a depth, in the volume's index space.
    glm::dvec3 middle_at(double depth) const { return middle_ + depth * middle_change_; }

  private:
    // Slabs up to `end` - 1, and whether they may be visible.
    struct SlabRange {
        int end;
        bool shown;
    };
    // Returns a range of slabs, from `first` on, that one test decides.
    SlabRange next_range(const OccupiedBricks& bricks, const CpuRays& rays, int first,
                         int end) const;
    // Tells whether a ray may come near an occupied brick in slabs first .. end - 1.
    bool shows(const OccupiedBricks& bricks, const CpuRays& rays, int first, int end) const;

    // The middle ray in index space, linear in depth, which counts from the nearest slab's front.
    glm::dvec3 middle_{0}, middle_change_{0};
    // Largest distance from the middle ray, including the error of points.
    glm::dvec3 reach_{0}, reach_change_{0};
};

// Sets a tile to the picture of a compositing tree with nodes in float (docs/numerics.md, section
// 4). Each vector of pixels goes through the tree by itself, nearest slab first; if the root is a
// leaf, in registers. Returns the number of segments that were evaluated.
std::int64_t march_tile(const CpuSlabs& slabs, const TreeShape& shape, const TileGrid::Tile& area,
                        TilePixels& pixels);

// Composites all slabs onto a tile in the plan's order. Returns the number of segments.
std::int64_t blend_tile(const CpuSlabs& slabs, const TargetBlend& blend, const TileGrid::Tile& area,
                        TilePixels& pixels);

// Composites the opacity alone of some slabs onto one channel: a leaf of a tree of fixed-point
// nodes. Optical depths are multiplied by `depth_scale`.
std::int64_t blend_tile_opacity(const CpuSlabs& slabs, const TargetBlend& blend,
                                const TileGrid::Tile& area, const SampleSpan& span,
                                double depth_scale, TilePixels::Plane& opacity);

}  // namespace lamina
