// SPDX-License-Identifier: Apache-2.0
// The vector functions of tiles/*-inl.h over arrays, for tests; they use the instruction set in
// use. All arrays of a call have the same length, a multiple of 16. The last argument gets the
// results.
#pragma once

#include <cstdint>
#include <span>

#include "compositing/codes.h"
#include "tiles/tile_image.h"

namespace lamina {

using Floats = std::span<const float>;
using Numbers = std::span<const double>;
using Bits = std::span<const std::uint32_t>;

// Returns the number of floats in a vector.
int vector_lanes();

void vector_exp(Floats x, std::span<float> result);
void vector_log(Floats x, std::span<float> result);
void vector_opacity(Floats depth, std::span<float> result);
void vector_opacity(Numbers depth, std::span<double> result);
void vector_encode(NodeCode code, float share, Floats depth, std::span<float> result);
void vector_decode(NodeCode code, float share, Floats value, std::span<float> result);

struct CodeOperands {
    Numbers color, alpha, below, above_alpha;
};
void vector_over(OverRounding rounding, double largest, const CodeOperands& codes,
                 std::span<double> result);
void vector_under(OverRounding rounding, double largest, const CodeOperands& codes,
                  std::span<double> result);
void vector_code_nearest(Numbers scaled, std::span<double> result);
void vector_round_alpha(AlphaRounding rounding, Numbers scaled, Bits random,
                        std::span<double> result);
// result[i] is the code of scaled[i] in a slab of rank[i].
void vector_dither(double largest, int period, int increment, Numbers scaled, Bits rank,
                   std::span<double> result);
void vector_over_stochastic(double largest, Numbers source, Numbers alpha, Numbers below,
                            Bits random, std::span<double> result);
void vector_random_bits(Bits column, Bits row, Bits sample, std::uint32_t seed,
                        std::span<std::uint32_t> result);

// The planes of some pixels: red, green, blue, alpha.
struct FloatPlanes {
    std::span<float> planes[4];
};
struct ConstFloatPlanes {
    Floats planes[4];
};
void vector_blend(const TargetBlend& target, const ConstFloatPlanes& fragments, FloatPlanes pixels);
void vector_blend_opacity(const TargetBlend& target, Floats opacity, std::span<float> pixels);
void vector_composite_codes(const TargetBlend& target, const ConstFloatPlanes& codes,
                            FloatPlanes pixels);
void vector_composite_opacity(const TargetBlend& target, Floats alpha, std::span<float> pixels);
void vector_composite_stochastic(const TargetBlend& target, const ConstFloatPlanes& fragments,
                                 Bits random, FloatPlanes pixels);
void vector_alpha_code(const TargetBlend& target, Floats opacity, Bits random,
                       std::span<float> result);
void vector_dithered_code(const TargetBlend& target, const Dither& dither, std::uint32_t rank,
                          Floats value, std::span<float> result);
void vector_color_code(const TargetBlend& target, Floats color, std::span<float> result);

}  // namespace lamina
