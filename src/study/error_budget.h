// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "image/difference.h"
#include "image/metrics.h"
#include "lamina/image.h"
#include "lamina/image_color_space.h"

namespace lamina::study {

// One volume drawn by two methods, and for each method the exact picture of the data that it draws.
struct FourPictures {
    Image traced_volume, traced_mesh, sliced, projected;
    ImageColorSpace space = ImageColorSpace::linear;  // of all four
};

// Splits the difference of the two methods into parts, in every pixel:
//   projected - sliced = (traced mesh - traced volume) - (sliced - traced volume)
//                      + (projected - traced mesh)
struct ErrorBudget {
    struct Part {
        std::string name;
        Difference e;  // in 1/255
        ImageError error;
        // The share of the raw difference d that the part s explains: <s, d> / <d, d>, with the
        // part's sign in the sum above. The three shares add up to 1. It is 0 where d is 0.
        double share = 0;
    };

    std::array<Part, 3> parts;  // mesh discretisation, slicing method, projection method
    Difference raw;             // projected - sliced
    ImageError raw_error;
    double residual = 0;  // largest |raw - sum of the parts|, in 1/255; this is rounding

    const Part& dominant() const;  // the part with the largest L2
};

// Throws Error where the pictures differ in size.
ErrorBudget error_budget(const FourPictures& pictures);

}  // namespace lamina::study
