// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "image/difference.h"
#include "lamina/image.h"
#include "lamina/image_color_space.h"

namespace lamina::study {

// One volume drawn by two methods, and for each method the exact picture of the data that it draws.
struct FourPictures {
    Image traced_volume, traced_mesh, sliced, projected;
    ImageColorSpace space = ImageColorSpace::linear;  // of all of them
    // Of a lit scene, traced without light; empty where it is not lit.
    Image unlit_volume{}, unlit_mesh{};
};

// Splits the difference of the two methods into parts, in every pixel:
//   projected - sliced = (traced mesh - traced volume) - (sliced - traced volume)
//                      + (projected - traced mesh)
// Of a lit scene, the first part is that of the unlit pictures, and what light adds to it is a part
// of its own, the gradients: a mesh has other ones than the volume that it is made from.
struct ErrorBudget {
    struct Part {
        std::string key, name;  // in files, in sentences
        Difference e;           // in 1/255
        ImageError error;
        // The share of the raw difference d that the part s explains: <s, d> / <d, d>, with the
        // part's sign in the sum above. The shares add up to 1. It is 0 where d is 0.
        double share = 0;
    };

    // Mesh discretisation, slicing method, projection method; of a lit scene the gradients, too.
    std::vector<Part> parts;
    Difference raw;  // projected - sliced
    ImageError raw_error;
    double residual = 0;  // largest |raw - sum of the parts|, in 1/255; this is rounding

    const Part& dominant() const;  // the part with the largest L2
};

// Throws Error where the pictures differ in size.
ErrorBudget error_budget(const FourPictures& pictures);

}  // namespace lamina::study
