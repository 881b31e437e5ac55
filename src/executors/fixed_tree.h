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

// The value of each code Phi of a child in its node (LaMar 2004, section 6.2): 1 - (1 - Phi)^share
// times the largest code. It is computed in double precision and split into its whole part and the
// rest.
struct Swizzle {
    std::vector<float> whole, rest;
};

// Swizzles that a tree of fixed-point nodes needs. The key is the number of samples of the child
// and of the node. `bits`: length of a code.
using Swizzles = std::map<std::pair<int, int>, Swizzle>;
Swizzles make_swizzles(const TreeShape& shape, int bits);

// Composites the opacity of some samples, as codes, onto a plane of a tile, in the plan's order.
// Samples are numbered in visibility order; 0 is the nearest to the eye. Optical depths are
// multiplied by `depth_scale`, the number of all samples over that of the leaf.
using TileLeaves =
    std::function<void(const SampleSpan& span, double depth_scale, TilePixels::Plane& opacity)>;

// LaMar's exponent-factoring (2004, section 6) on the CPU; GlFixedTree does it with OpenGL. Every
// node composites opacity in a plane of fixed-point codes, which goes through a table into the
// plane of its parent. One plane a level is enough, because a node's plane is used up at once.
class CpuFixedTree {
  public:
    // `plan`: how the nodes composite. Leaves may be drawn in another way.
    CpuFixedTree(const CompositingPlan& plan, const TreeShape& shape,
                 const std::array<float, 3>& single_color);

    // Replaces a tile by the picture of the leaves. Safe from several threads at a time.
    void draw(const TileGrid::Tile& area, const TileLeaves& leaves, TilePixels& pixels) const;

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

}  // namespace lamina
