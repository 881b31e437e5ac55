// SPDX-License-Identifier: Apache-2.0
#include "executors/tile_fixed_tree.h"

#include "base/client.h"

namespace lamina {

struct TileFixedTree::Evaluation {
    const TileGrid::Tile& area;
    TileLeaves& leaves;
    std::uint32_t swizzled = 0;  // number of nodes so far
    // There is one plane a level. A shape may have one level more than its factors.
    alignas(64) std::array<TilePixels::Plane, max_tree_levels + 1> planes;
};

TileFixedTree::TileFixedTree(const CompositingPlan& plan, const TreeShape& shape,
                             const std::array<float, 3>& single_color)
    : blend_(target_blend(plan)),
      emulated_(plan.emulation.has_value()),
      shape_(shape),
      single_color_(single_color),
      swizzles_(make_swizzles(shape, blend_.bits)) {}

void TileFixedTree::draw(const TileGrid::Tile& area, TileLeaves& leaves, TilePixels& pixels) const {
    Evaluation evaluation{area, leaves, 0, {}};
    evaluate(0, shape_.root(), evaluation);
    colorize(evaluation.planes[0], pixels);
}

void TileFixedTree::colorize(const TilePixels::Plane& root, TilePixels& pixels) const {
    colorize_tile(blend_, emulated_, single_color_, root, pixels);
}

void TileFixedTree::put_into_parent(const SampleSpan& child, const SampleSpan& node,
                                    std::uint32_t number, const TileGrid::Tile& area,
                                    const TilePixels::Plane& from, TilePixels::Plane& to) const {
    const Swizzle& swizzle = swizzles_.at({child.count, node.count});
    const auto samples = static_cast<std::uint32_t>(shape_.samples());
    swizzle_tile({blend_, emulated_, swizzle.whole.data(), swizzle.rest.data(), samples + number},
                 area, from, to);
}

void TileFixedTree::evaluate(int level, const SampleSpan& node, Evaluation& evaluation) const {
    TilePixels::Plane& plane = evaluation.planes[static_cast<std::size_t>(level)];
    plane.fill(0);
    if (shape_.is_leaf(level, node)) {
        check_interrupt();
        evaluation.leaves.draw(node, static_cast<double>(shape_.samples()) / node.count, plane);
        return;
    }
    const int children = shape_.factor(level);
    for (int i = 0; i < children; ++i) {
        const bool back_to_front = blend_.order == Order::back_to_front;
        const SampleSpan child = child_span(node, back_to_front ? children - 1 - i : i, children);
        if (child.count == 0) continue;
        evaluate(level + 1, child, evaluation);
        put_into_parent(child, node, evaluation.swizzled++, evaluation.area,
                        evaluation.planes[static_cast<std::size_t>(level) + 1], plane);
    }
}

std::int64_t TileFixedTree::byte_count() const {
    std::size_t bytes = 0;
    for (const auto& [sizes, swizzle] : swizzles_)
        bytes += sizeof(float) * (swizzle.whole.size() + swizzle.rest.size());
    return static_cast<std::int64_t>(bytes);
}

}  // namespace lamina
