// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "image/difference.h"
#include "lamina/error_norms.h"

namespace lamina {

struct ImageError {
    struct Worst {
        int column = 0, row = 0;
        std::size_t channel = 0;  // index into `channels`
        double e = 0;
    };

    std::vector<std::string> channels;
    std::vector<ErrorNorms> of_channel;
    ErrorNorms all;
    Worst worst;  // the first component with |e| = all.linf
};

// Throws Error where some e is not finite.
ImageError measure(const Difference& difference);

template <typename RealA, typename RealB>
ImageError image_error(const RgbaImage<RealA>& a, const RgbaImage<RealB>& b) {
    return measure(difference(a, b));
}

}  // namespace lamina
