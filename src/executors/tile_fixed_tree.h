// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "compositing/tree_shape.h"
#include "executors/swizzle.h"
#include "tiles/target_blend.h"
#include "tiles/tile_image.h"

namespace lamina {

// What a tree of fixed-point nodes is made of, in one tile: samples in the order of visibility, 0
// nearest the eye.
class TileLeaves {
  public:
    virtual ~TileLeaves() = default;

    // Composites the opacity of these samples onto a plane of the tile, in the plan's order and as
    // codes. Optical depths are multiplied by `depth_scale`: all samples over those of the leaf.
    virtual void draw(const SampleSpan& span, double depth_scale, TilePixels::Plane& opacity) = 0;
};

// LaMar's exponent-factoring (2004, section 6) in tiles: every node composites opacity in a plane
// of fixed-point codes, which goes through a table into its parent's. One plane a level is enough,
// because a node's plane is used up at once. Twin of GlFixedTree.
class TileFixedTree {
  public:
    // `plan`: of the nodes. Leaves may be drawn in another way.
    TileFixedTree(const CompositingPlan& plan, const TreeShape& shape,
                  const std::array<float, 3>& single_color);

    // Replaces a tile by the picture of the leaves. Safe from several threads at a time.
    void draw(const TileGrid::Tile& area, TileLeaves& leaves, TilePixels& pixels) const;

    // Its steps by themselves, for those who evaluate the tree: puts a child's opacity into that of
    // its node, the `number`th one to do so in the frame; replaces pixels by what the root shows.
    void put_into_parent(const SampleSpan& child, const SampleSpan& node, std::uint32_t number,
                         const TileGrid::Tile& area, const TilePixels::Plane& from,
                         TilePixels::Plane& to) const;
    void colorize(const TilePixels::Plane& root, TilePixels& pixels) const;

    std::int64_t byte_count() const;

  private:
    struct Evaluation;

    void evaluate(int level, const SampleSpan& node, Evaluation& evaluation) const;

    TargetBlend blend_;
    bool emulated_;
    TreeShape shape_;
    std::array<float, 3> single_color_;
    Swizzles swizzles_;
};

// The vector parts of it.
struct TileSwizzle {
    TargetBlend blend;
    bool emulated = false;
    const float *whole = nullptr, *rest = nullptr;
    std::uint32_t stage = 0;  // of the frame: for stochastic rounding
};
void swizzle_tile(const TileSwizzle& swizzle, const TileGrid::Tile& area,
                  const TilePixels::Plane& child, TilePixels::Plane& node);
void colorize_tile(const TargetBlend& blend, bool emulated,
                   const std::array<float, 3>& single_color, const TilePixels::Plane& root,
                   TilePixels& pixels);

}  // namespace lamina
