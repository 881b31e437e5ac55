// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lamina/export.h"
#include "lamina/image.h"

namespace lamina {

// Norms of the error e of a picture in units of 1/255 (docs/numerics.md; the signed mean is what
// LaMar's Table 4 calls L1).
struct ErrorNorms {
    double linf = 0;  // max |e|
    double l1 = 0;    // mean of e, with its sign
    double l2 = 0;    // root of the mean of e^2
};

// Measures a picture against the truth, over all pixels and channels (red, green, blue, opacity).
// Throws Error where their sizes differ or a number is none.
LAMINA_API ErrorNorms error_of(const Image& picture, const Image& truth);
LAMINA_API ErrorNorms error_of(const Image& picture, const PreciseImage& truth);

}  // namespace lamina
