// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gl/texture_format.h"

namespace lamina::gl {

// Largest deviation of the current context's linear filter from exact trilinear interpolation, for
// a 3D texture of r8, r16 or r32f, as a fraction of the range of its values. llvmpipe: 1e-7, but
// 8e-3 for r8, whose results it rounds to 8 bits; GPUs with 8-bit weights: 1e-3 (NUMERICS section
// 2).
double measure_filter_error(TextureFormat format);

// What weights rounded to 8 bits can cost: 1/512 of a step along each axis.
constexpr double eight_bit_filter_error = 3. / 512;

}  // namespace lamina::gl
