// SPDX-License-Identifier: Apache-2.0
#include "executors/fixed_tree.h"

#undef LAMINA_TARGET_FILE
#define LAMINA_TARGET_FILE "executors/fixed_tree.cpp"
#include "simd/foreach_target.h"

#include "base/client.h"
#include "compositing/codes.h"
#include "tiles/target_pixels-inl.h"

LAMINA_SIMD_BEGIN

// Composites a child's image onto its node's (LaMar 2004, section 6.2, "swizzle"), as
// shaders/slicing/swizzle.frag. `stage`: number of the step in the frame, for stochastic rounding.
void swizzle_pixels(const TargetBlend& target, bool emulated, const Swizzle& swizzle,
                    std::uint32_t stage, const TileGrid::Tile& area, const TilePixels::Plane& child,
                    TilePixels::Plane& node) {
    for (std::size_t place = 0; place < TileGrid::pixels; place += Float::lanes) {
        const TileGrid::Place at = TileGrid::pixel_at(static_cast<int>(place));
        if (at.column >= area.width || at.row >= area.height) continue;
        const Int code = to_int(load<Float>(child.data() + place));
        const Float whole = gather(swizzle.whole.data(), code);
        const Float rest = gather(swizzle.rest.data(), code);
        Float there = load<Float>(node.data() + place);
        if (emulated) {
            Word random(0);
            if (target.alpha_rounding == AlphaRounding::stochastic) {
                random = random_of_pixels(area.column + at.column, area.row + at.row, stage,
                                          target.seed);
            }
            const ScaledValues<Float64> scaled{Float64(whole), Float64(rest)};
            const Float64 alpha = round_alpha(target.alpha_rounding, scaled, Float64(random));
            composite_opacity(target, to_float(alpha), there);
        } else {
            blend_opacity(target, (whole + rest) / target.largest, there);
        }
        store(there, node.data() + place);
    }
}

// Makes the picture of the root's opacity and one colour, as shaders/slicing/colorize.frag does.
void colorize_pixels(const TargetBlend& target, bool emulated,
                     const std::array<float, 3>& single_color, const TilePixels::Plane& root,
                     TilePixels& pixels) {
    pixels.alpha = root;
    TilePixels::Plane* const planes[3] = {&pixels.red, &pixels.green, &pixels.blue};
    const float unit = 1 / target.largest;  // codes become values as when textures are read
    for (std::size_t channel = 0; channel < 3; ++channel) {
        const Float color(single_color[channel]);
        const Float code = color_code(target, color);
        for (std::size_t place = 0; place < TileGrid::pixels; place += Float::lanes) {
            const Float alpha = load<Float>(root.data() + place);
            // Emulated OVER onto an empty pixel gives the product, rounded.
            const Float associated =
                emulated ? composite_channel(target, code, alpha, Float(0), Float(0))
                         : native_code(target.largest, color * (alpha * unit));
            store(associated, planes[channel]->data() + place);
        }
    }
}

LAMINA_SIMD_END

#if LAMINA_ONCE
namespace lamina {
namespace {

Swizzle make_swizzle(double share, int bits) {
    const std::uint32_t largest = largest_code(bits);
    Swizzle swizzle;
    for (std::uint32_t code = 0; code <= largest; ++code) {
        const double phi = static_cast<double>(code) / largest;
        const ScaledValue scaled = split_scaled(largest * opacity_over(phi, share));
        swizzle.whole.push_back(static_cast<float>(scaled.whole));
        swizzle.rest.push_back(static_cast<float>(scaled.rest));
    }
    return swizzle;
}

// Adds the swizzles of a node and of those below it. The nodes of a level have only a few sizes,
// and each pair of sizes is added once.
void add_swizzles(const TreeShape& shape, int bits, int level, const SampleSpan& node,
                  Swizzles& swizzles) {
    if (shape.is_leaf(level, node)) return;
    int last_size = 0;
    for (int i = 0; i < shape.factor(level); ++i) {
        const SampleSpan child = child_span(node, i, shape.factor(level));
        if (child.count == 0 || child.count == last_size) continue;
        last_size = child.count;
        const auto [place, made] = swizzles.try_emplace({child.count, node.count});
        if (made) place->second = make_swizzle(static_cast<double>(child.count) / node.count, bits);
        if (made || child.count == node.count)
            add_swizzles(shape, bits, level + 1, child, swizzles);
    }
}

}  // namespace

Swizzles make_swizzles(const TreeShape& shape, int bits) {
    Swizzles swizzles;
    add_swizzles(shape, bits, 0, shape.root(), swizzles);
    return swizzles;
}

LAMINA_EXPORT(swizzle_pixels);
LAMINA_EXPORT(colorize_pixels);

struct CpuFixedTree::Evaluation {
    const TileGrid::Tile& area;
    const TileLeaves& leaves;
    std::uint32_t inserted_nodes = 0;  // number of children composited so far
    // The image of each level's present node. A shape may have one level more than factors.
    alignas(64) std::array<TilePixels::Plane, max_tree_levels + 1> planes;
};

CpuFixedTree::CpuFixedTree(const CompositingPlan& plan, const TreeShape& shape,
                           const std::array<float, 3>& single_color)
    : blend_(target_blend(plan)),
      emulated_(plan.emulation.has_value()),
      shape_(shape),
      single_color_(single_color),
      swizzles_(make_swizzles(shape, blend_.bits)) {}

void CpuFixedTree::draw(const TileGrid::Tile& area, const TileLeaves& leaves,
                        TilePixels& pixels) const {
    Evaluation evaluation{area, leaves, 0, {}};
    evaluate(0, shape_.root(), evaluation);
    colorize(evaluation.planes[0], pixels);
}

void CpuFixedTree::colorize(const TilePixels::Plane& root, TilePixels& pixels) const {
    LAMINA_DISPATCH(colorize_pixels)(blend_, emulated_, single_color_, root, pixels);
}

void CpuFixedTree::put_into_parent(const SampleSpan& child, const SampleSpan& node,
                                   std::uint32_t number, const TileGrid::Tile& area,
                                   const TilePixels::Plane& from, TilePixels::Plane& to) const {
    const std::uint32_t stage = static_cast<std::uint32_t>(shape_.samples()) + number;
    LAMINA_DISPATCH(swizzle_pixels)
    (blend_, emulated_, swizzles_.at({child.count, node.count}), stage, area, from, to);
}

void CpuFixedTree::evaluate(int level, const SampleSpan& node, Evaluation& evaluation) const {
    TilePixels::Plane& plane = evaluation.planes[static_cast<std::size_t>(level)];
    plane.fill(0);
    if (shape_.is_leaf(level, node)) {
        check_interrupt();
        evaluation.leaves(node, static_cast<double>(shape_.samples()) / node.count, plane);
        return;
    }
    const int children = shape_.factor(level);
    for (int i = 0; i < children; ++i) {
        const bool back_to_front = blend_.order == Order::back_to_front;
        const SampleSpan child = child_span(node, back_to_front ? children - 1 - i : i, children);
        if (child.count == 0) continue;
        evaluate(level + 1, child, evaluation);
        put_into_parent(child, node, evaluation.inserted_nodes++, evaluation.area,
                        evaluation.planes[static_cast<std::size_t>(level) + 1], plane);
    }
}

std::int64_t CpuFixedTree::byte_count() const {
    std::size_t bytes = 0;
    for (const auto& [sizes, swizzle] : swizzles_)
        bytes += sizeof(float) * (swizzle.whole.size() + swizzle.rest.size());
    return static_cast<std::int64_t>(bytes);
}

}  // namespace lamina
#endif
