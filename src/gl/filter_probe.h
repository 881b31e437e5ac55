// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace lamina::gl {

// Largest deviation of the current context's linear filter from exact trilinear interpolation, for
// an R32F 3D texture, as a fraction of the range of its values. llvmpipe: 1e-7; GPUs with 8-bit
// weights: 1e-3 (NUMERICS section 2).
double measure_float_filter_error();

}  // namespace lamina::gl
