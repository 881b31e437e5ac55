// SPDX-License-Identifier: Apache-2.0
#include "projection/tile_tet_tree.h"

#include <algorithm>

#include "base/client.h"
#include "base/parallel.h"

namespace lamina {

TileTetTree::TileTetTree(const CompositingPlan& plan, const TreeShape& shape,
                         const std::array<float, 3>& single_color, const TileGrid& grid)
    : shape_(shape),
      tree_(plan, shape, single_color),
      grid_(grid),
      nodes_(static_cast<std::size_t>(shape.levels())) {
    for (Node& node : nodes_) {
        node.opacity.resize(static_cast<std::size_t>(grid.count()));
        node.touched.resize(node.opacity.size());
    }
}

void TileTetTree::draw(const DrawLeaf& draw_leaf, TileImage& image, Progress* progress) {
    swizzled_ = 0;
    evaluate(0, shape_.root(), draw_leaf, progress);
    parallel_for(grid_.count(), 8, [&](std::int64_t tile) {
        tree_.colorize(nodes_[0].opacity[static_cast<std::size_t>(tile)],
                       image.tile(static_cast<int>(tile)));
    });
}

void TileTetTree::evaluate(int level, const SampleSpan& span, const DrawLeaf& draw_leaf,
                           Progress* progress) {
    Node& node = nodes_[static_cast<std::size_t>(level)];
    clear(node);
    if (shape_.is_leaf(level, span)) {
        draw_leaf(span, static_cast<double>(shape_.samples()) / span.count, node);
        if (progress != nullptr) progress->advance();
        check_interrupt();
        return;
    }
    const int children = shape_.factor(level);
    for (int i = children; i-- > 0;) {  // back to front
        const SampleSpan child = child_span(span, i, children);
        if (child.count == 0) continue;
        evaluate(level + 1, child, draw_leaf, progress);
        put_into_parent(level, child, span);
    }
}

void TileTetTree::clear(Node& node) const {
    for (std::size_t tile = 0; tile < node.touched.size(); ++tile) {
        if (node.touched[tile] != 0) node.opacity[tile].fill(0);
        node.touched[tile] = 0;
    }
}

// A sample without opacity adds none, however it is rounded.
void TileTetTree::put_into_parent(int level, const SampleSpan& child, const SampleSpan& parent) {
    const Node& from = nodes_[static_cast<std::size_t>(level) + 1];
    Node& to = nodes_[static_cast<std::size_t>(level)];
    const std::uint32_t number = swizzled_++;
    parallel_for(grid_.count(), 8, [&](std::int64_t place) {
        const auto tile = static_cast<std::size_t>(place);
        if (from.touched[tile] == 0) return;
        to.touched[tile] = 1;
        tree_.put_into_parent(child, parent, number, grid_.tile(static_cast<int>(place)),
                              from.opacity[tile], to.opacity[tile]);
    });
}

std::int64_t TileTetTree::byte_count() const {
    std::int64_t bytes = tree_.byte_count();
    for (const Node& node : nodes_)
        bytes += static_cast<std::int64_t>(node.opacity.size() * (sizeof(TilePlane) + 1));
    return bytes;
}

}  // namespace lamina
