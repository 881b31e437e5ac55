// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gl/texture_format.h"

namespace lamina::gl {

// How a filter deviates from exact trilinear interpolation, at most, as fractions of the range of
// the values.
struct FilterError {
    double found = 0;
    double eight_bit = 0;  // with weights rounded to 8 bits instead, at the same places
    // Truncated weights, or those of 7 bits, are twice as bad.
    bool as_good_as_eight_bits() const { return found <= 1.1 * eight_bit; }
};

// Of the current context's linear filter of a 3D texture of r8, r16 or r32f. llvmpipe: 1e-7, but
// .18 for r8, of values 7 codes apart: it rounds results to codes (docs/numerics.md, section 2).
FilterError measure_filter_error(TextureFormat format);

}  // namespace lamina::gl
