// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "compositing/tree_shape.h"
#include "tiles/tile_image.h"

namespace lamina {

// A table for compositing a child's image onto its node (LaMar 2004, section 6.2): for each code
// Phi, 1 - (1 - Phi)^share times the largest code, computed in double precision and split into its
// whole part and the rest. `share` is the child's share of the node's samples.
struct Swizzle {
    std::vector<float> whole, rest;
};

// The swizzles of a tree, by numbers of samples of child and node. `bits`: length of a code.
using Swizzles = std::map<std::pair<int, int>, Swizzle>;
Swizzles make_swizzles(const TreeShape& shape, int bits);

// Composites the opacity of some samples, as codes, onto a plane of a tile, in the plan's order.
// Samples (slabs, or tets) are numbered in visibility order, nearest first. Optical depths are
// multiplied by `depth_scale`, the number of all samples over that of the leaf.
using TileLeaves =
    std::function<void(const SampleSpan& span, double depth_scale, TilePixels::Plane& opacity)>;

// Composites by LaMar's exponent-factoring (2004, section 6) on the CPU, as GlFixedTree does with
// OpenGL. Each node composites opacity in a plane of fixed-point codes. As soon as a plane is
// complete, it goes through a Swizzle into its parent's, so one plane a level is enough.
class CpuFixedTree {
  public:
    // `plan`: how nodes composite. Leaves may be drawn in another way.
    CpuFixedTree(const CompositingPlan& plan, const TreeShape& shape,
                 const std::array<float, 3>& single_color);

    // Sets a tile to the picture of the leaves. May be called from several threads at a time.
    void draw(const TileGrid::Tile& area, const TileLeaves& leaves, TilePixels& pixels) const;

    // Steps of draw(), for callers that evaluate the tree themselves. put_into_parent() composites
    // a child's opacity (`from`) onto its node's (`to`); `number` counts these calls in a frame.
    // colorize() sets pixels to the root's opacity in the single colour.
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

}  // namespace lamina
