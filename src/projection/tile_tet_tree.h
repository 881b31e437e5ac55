// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "base/progress.h"
#include "compositing/tree_shape.h"
#include "executors/fixed_tree.h"
#include "tiles/tile_image.h"

namespace lamina {

// A tree of fixed-point nodes whose samples are composited onto all tiles together. It keeps one
// plane for each tile and level, and takes its memory once.
class TileTetTree {
  public:
    // The opacity of one node, and the tiles with opacity above 0.
    struct Node {
        std::vector<TilePlane> opacity;
        std::vector<std::uint8_t> touched;
    };
    // Composites samples onto a node that is 0, as TileLeaves do, but for all tiles.
    using DrawLeaf = std::function<void(const SampleSpan&, double depth_scale, Node&)>;

    // `plan`: how the nodes composite. Leaves may be drawn in another way.
    TileTetTree(const CompositingPlan& plan, const TreeShape& shape,
                const std::array<float, 3>& single_color, const TileGrid& grid);

    int step_count() const { return static_cast<int>(shape_.leaf_count()); }
    // Replaces the picture by that of the leaves. Ctrl-C ends it between leaves.
    void draw(const DrawLeaf& draw_leaf, TileImage& image, Progress* progress);
    std::int64_t byte_count() const;

  private:
    void evaluate(int level, const SampleSpan& span, const DrawLeaf& draw_leaf, Progress* progress);
    void clear(Node& node) const;
    void put_into_parent(int level, const SampleSpan& child, const SampleSpan& parent);

    TreeShape shape_;
    TileFixedTree tree_;
    TileGrid grid_;
    std::vector<Node> nodes_;  // by level
    // Number of nodes in this frame so far, which seeds stochastic rounding.
    std::uint32_t swizzled_ = 0;
};

}  // namespace lamina
