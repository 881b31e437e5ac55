// SPDX-License-Identifier: Apache-2.0
#include "compositing/fixed_ray.h"

#include <vector>

namespace lamina {
namespace {

// Turns opacities and colours of a ray's samples and nodes into codes.
class Coder {
  public:
    Coder(const Emulation& emulation, const std::optional<Dither>& dither, std::uint32_t column,
          std::uint32_t row)
        : emulation_(emulation), dither_(dither), column_(column), row_(row) {
        if (!dither_) return;
        alpha_ranks_ = dither_ranks(dither_->period, dither_->seed);
        if (dither_->color) color_ranks_ = dither_ranks(dither_->period, dither_->seed + 1);
    }

    std::uint32_t largest() const { return largest_code(emulation_.bits); }

    // Rounds an opacity to a code. `stage`: unique among a pixel's roundings; seeds random bits.
    std::uint32_t round(double opacity, std::uint32_t stage) const {
        const double scaled = largest() * opacity;
        const std::uint32_t random = emulation_.alpha == AlphaRounding::stochastic
                                         ? random_bits(column_, row_, stage, emulation_.seed)
                                         : 0;
        return round_alpha(emulation_.alpha, split_scaled(scaled), random);
    }

    std::uint32_t sample_alpha(double opacity, int slab) const {
        if (!dither_) return round(opacity, static_cast<std::uint32_t>(slab));
        return dithered(largest() * opacity, alpha_ranks_, slab);
    }

    std::uint32_t sample_color(double color, int slab) const {
        return color_ranks_.empty() ? code_nearest(largest() * color)
                                    : dithered(largest() * color, color_ranks_, slab);
    }

  private:
    std::uint32_t dithered(double scaled, const std::vector<std::uint32_t>& ranks, int slab) const {
        const auto place = static_cast<std::size_t>(slab % dither_->period);
        return dither_code(scaled, ranks[place], dither_->period, dither_->increment, largest());
    }

    const Emulation& emulation_;
    const std::optional<Dither>& dither_;
    std::uint32_t column_, row_;
    std::vector<std::uint32_t> alpha_ranks_, color_ranks_;
};

// Evaluates a compositing tree on one ray: composites a node's children in order, each with its
// transmittance raised to the power of its share of the node's samples (exponent-factoring).
struct TreeCompositor {
    std::span<const double> unit_opacities;
    const TreeShape& tree;
    const Emulation& emulation;
    Order order;
    const Coder& coder;
    int inserted_nodes = 0;

    std::uint32_t evaluate(int level, const SampleSpan& node) {
        const bool leaf = tree.is_leaf(level, node);
        const int children = leaf ? node.count : tree.factor(level);
        std::uint32_t composited = 0;
        for (int i = 0; i < children; ++i) {
            const int child = order == Order::back_to_front ? children - 1 - i : i;
            const SampleSpan span =
                leaf ? SampleSpan{node.first + child, 1} : child_span(node, child, children);
            if (span.count == 0) continue;
            const double share = static_cast<double>(span.count) / node.count;
            const std::uint32_t alpha =
                leaf ? leaf_alpha(span.first, share) : swizzle(evaluate(level + 1, span), share);
            composited =
                order == Order::back_to_front
                    ? over(emulation.over, coder.largest(), alpha, composited, coder.largest())
                    : under(emulation.over, coder.largest(), alpha, composited, composited,
                            coder.largest());
        }
        return composited;
    }

    std::uint32_t leaf_alpha(int slab, double share) const {
        return coder.sample_alpha(
            opacity_over(unit_opacities[static_cast<std::size_t>(slab)], share), slab);
    }

    // Returns a node's opacity as its parent composites it: the exponent-swizzle of LaMar 2004.
    // Nodes are numbered as they are evaluated, after the samples.
    std::uint32_t swizzle(std::uint32_t code, double share) {
        const double phi = static_cast<double>(code) / coder.largest();
        const auto stage = static_cast<std::uint32_t>(tree.samples() + inserted_nodes++);
        return coder.round(opacity_over(phi, share), stage);
    }
};

}  // namespace

FixedPixel composite_straight(std::span<const RaySample> samples, const Emulation& emulation,
                              const std::optional<Dither>& dither, Order order,
                              std::uint32_t column, std::uint32_t row) {
    const Coder coder(emulation, dither, column, row);
    const std::uint32_t largest = coder.largest();
    const int count = static_cast<int>(samples.size());
    FixedPixel pixel;
    for (int i = 0; i < count; ++i) {
        const int slab = order == Order::back_to_front ? count - 1 - i : i;
        const RaySample& sample = samples[static_cast<std::size_t>(slab)];
        const std::uint32_t color = coder.sample_color(sample.color, slab);
        const std::uint32_t alpha = coder.sample_alpha(sample.alpha, slab);
        if (order == Order::back_to_front) {
            pixel.color = over(emulation.over, color, alpha, pixel.color, largest);
            pixel.alpha = over(emulation.over, largest, alpha, pixel.alpha, largest);
        } else {
            pixel.color = under(emulation.over, color, alpha, pixel.color, pixel.alpha, largest);
            pixel.alpha = under(emulation.over, largest, alpha, pixel.alpha, pixel.alpha, largest);
        }
    }
    return pixel;
}

std::uint32_t composite_tree(std::span<const double> unit_opacities, const TreeShape& tree,
                             const Emulation& emulation, const std::optional<Dither>& dither,
                             Order order, std::uint32_t column, std::uint32_t row) {
    const Coder coder(emulation, dither, column, row);
    return TreeCompositor{unit_opacities, tree, emulation, order, coder}.evaluate(0, tree.root());
}

}  // namespace lamina
