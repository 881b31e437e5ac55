// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "compositing/tree_shape.h"
#include "executors/swizzle.h"
#include "tiles/target_blend.h"
#include "tiles/tile_image.h"

namespace lamina {

// The samples of a tree of fixed-point nodes in one tile. They are numbered in visibility order; 0
// is the nearest to the eye.
class TileLeaves {
  public:
    virtual ~TileLeaves() = default;

    // Composites the opacity of these samples, as codes, onto a plane of the tile, in the plan's
    // order. Optical depths are multiplied by `depth_scale`, the number of all samples over that of
    // the leaf.
    virtual void draw(const SampleSpan& span, double depth_scale, TilePixels::Plane& opacity) = 0;
};

// LaMar's exponent-factoring (2004, section 6) on the CPU; GlFixedTree does it with OpenGL. Every
// node composites opacity in a plane of fixed-point codes, which goes through a table into the
// plane of its parent. One plane a level is enough, because a node's plane is used up at once.
class TileFixedTree {
  public:
    // `plan`: how the nodes composite. Leaves may be drawn in another way.
    TileFixedTree(const CompositingPlan& plan, const TreeShape& shape,
                  const std::array<float, 3>& single_color);

    // Replaces a tile by the picture of the leaves. Safe from several threads at a time.
    void draw(const TileGrid::Tile& area, TileLeaves& leaves, TilePixels& pixels) const;

    // These steps of draw() are for callers that evaluate the tree themselves. put_into_parent()
    // puts a child's opacity into that of its node; `number` counts these calls in a frame.
    // colorize() replaces pixels by what the root shows.
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

// The steps of TileFixedTree that are compiled for each instruction set.
struct TileSwizzle {
    TargetBlend blend;
    bool emulated = false;
    const float *whole = nullptr, *rest = nullptr;
    std::uint32_t stage = 0;  // number of the step in the frame, for stochastic rounding
};
void swizzle_tile(const TileSwizzle& swizzle, const TileGrid::Tile& area,
                  const TilePixels::Plane& child, TilePixels::Plane& node);
void colorize_tile(const TargetBlend& blend, bool emulated,
                   const std::array<float, 3>& single_color, const TilePixels::Plane& root,
                   TilePixels& pixels);

}  // namespace lamina
