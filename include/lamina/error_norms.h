// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lamina/export.h"
#include "lamina/image.h"

namespace lamina {

// Norms of the error e of a picture, in units of 1/255 (docs/numerics.md).
struct ErrorNorms {
    double linf = 0;  // largest |e|
    // Mean of e, with its sign. Files and the command line call it `l1`, as LaMar's Table 4 does.
    double mean = 0;
    double l2 = 0;  // root of the mean of e^2
};

// Measures a picture against the truth, over all pixels and channels (red, green, blue, opacity).
// Throws Error if their sizes differ or a number is NaN or infinite.
LAMINA_API ErrorNorms error_of(const Image& picture, const Image& truth);
LAMINA_API ErrorNorms error_of(const Image& picture, const PreciseImage& truth);

}  // namespace lamina
