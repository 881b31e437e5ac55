// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "image/difference.h"

namespace lamina {

// Norms of e in units of 1/255 (docs/numerics.md). The signed mean is what LaMar's Table 4 calls
// L1.
struct ErrorNorms {
    double linf = 0;  // max |e|
    double l1 = 0;    // mean of e, with its sign
    double l2 = 0;    // root of the mean of e^2
};

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
