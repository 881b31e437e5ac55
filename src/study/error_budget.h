// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "image/difference.h"
#include "image/metrics.h"
#include "lamina/image.h"

namespace lamina::study {

// One volume drawn in two ways, and each of them against what the exact picture of its own data is.
struct FourPictures {
    Image traced_volume, traced_mesh, sliced, projected;
};

// Where the difference of the two ways comes from, in every pixel:
//   projected - sliced = (traced mesh - traced volume) - (sliced - traced volume)
//                      + (projected - traced mesh)
struct ErrorBudget {
    struct Part {
        std::string name;
        Difference e;  // in 1/255
        ImageError error;
        // Of the raw difference d that the part s explains: <s, d> / <d, d>, with the part's sign
        // in the sum above; the three add up to 1. 0 where d is 0.
        double share = 0;
    };

    std::array<Part, 3> parts;  // mesh discretisation, slicing method, PT method
    Difference raw;             // projected - sliced
    ImageError raw_error;
    double residual = 0;  // largest |raw - sum of the parts|, in 1/255: rounding

    const Part& dominant() const;  // with the largest L2
};

// All of one size; else throws Error.
ErrorBudget error_budget(const FourPictures& pictures);

}  // namespace lamina::study
