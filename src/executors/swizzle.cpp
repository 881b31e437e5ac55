// SPDX-License-Identifier: Apache-2.0
#include "executors/swizzle.h"

#include "compositing/codes.h"
#include "compositing/over.h"

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

// Nodes of a level have one of few sizes. Each size is added once.
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

}  // namespace lamina
