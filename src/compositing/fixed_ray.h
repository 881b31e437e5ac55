// SPDX-License-Identifier: Apache-2.0
// Fixed-point compositing of one ray on the CPU, for emulated targets and the plots of LaMar 2004.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "compositing/codes.h"
#include "compositing/tree_shape.h"
#include "lamina/settings.h"

namespace lamina {

// One colour channel and opacity, as codes. `color` is associated.
struct FixedPixel {
    std::uint32_t color = 0;
    std::uint32_t alpha = 0;
};

// A sample: colour in [0, 1], not associated, and opacity.
struct RaySample {
    double color = 1;
    double alpha = 0;
};

// Composites samples in order, nearest first. `column`, `row`: the pixel, for stochastic rounding.
FixedPixel composite_straight(std::span<const RaySample> samples, const Emulation& emulation,
                              const std::optional<Dither>& dither = {},
                              Order order = Order::back_to_front, std::uint32_t column = 0,
                              std::uint32_t row = 0);

// Composites samples in a tree by exponent-factoring (LaMar 2004, section 6; docs/numerics.md,
// section 3); returns the root's opacity as a code. `unit_opacities`: for each sample that of a
// whole ray like it. Samples may be dithered; nodes are rounded as the emulation rounds alpha.
std::uint32_t composite_tree(std::span<const double> unit_opacities, const TreeShape& tree,
                             const Emulation& emulation, const std::optional<Dither>& dither = {},
                             Order order = Order::back_to_front, std::uint32_t column = 0,
                             std::uint32_t row = 0);

}  // namespace lamina
