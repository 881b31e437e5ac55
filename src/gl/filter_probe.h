// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gl/texture.h"

namespace lamina::gl {

// The largest errors of a filter relative to exact trilinear interpolation, as fractions of the
// range of the values.
struct FilterError {
    double found = 0;
    double eight_bit = 0;  // error of weights rounded to 8 bits, at the same places
    // Tells whether the filter's weights are rounded to 8 bits or better. Truncated weights, or
    // those of 7 bits, err twice as much.
    bool as_good_as_eight_bits() const { return found <= 1.1 * eight_bit; }
};

// Measures the current context's linear filter of a 3D texture of r8, r16 or r32f. llvmpipe has
// 1e-7, except .18 for r8 with values 7 codes apart, because it rounds results to codes
// (docs/numerics.md, section 2).
FilterError measure_filter_error(TextureFormat format);

}  // namespace lamina::gl
