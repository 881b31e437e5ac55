// SPDX-License-Identifier: Apache-2.0
// Fixed-point compositing of one ray on the processor: the values that an emulated target holds,
// and that LaMar 2004 plots.
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

// Returns the pixel after all samples; sample 0 is the nearest to the eye. `column`, `row`: the
// pixel's place, for stochastic rounding.
FixedPixel composite_straight(std::span<const RaySample> samples, const Emulation& emulation,
                              const std::optional<Dither>& dither = {},
                              Order order = Order::back_to_front, std::uint32_t column = 0,
                              std::uint32_t row = 0);

// Exponent-factoring (LaMar 2004, section 6; docs/numerics.md, section 3). Returns the opacity of
// the root as a code. Samples are given by their per-unit opacity A, where the unit is the whole
// ray. Samples may be dithered; nodes are rounded like alpha.
std::uint32_t composite_tree(std::span<const double> unit_opacities, const TreeShape& tree,
                             const Emulation& emulation, const std::optional<Dither>& dither = {},
                             Order order = Order::back_to_front, std::uint32_t column = 0,
                             std::uint32_t row = 0);

}  // namespace lamina
