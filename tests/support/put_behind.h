// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "lamina/image.h"

namespace lamina {

// Composites a picture behind `front`, in double precision.
inline void put_behind(const Image& picture, PreciseImage& front) {
    for (std::size_t i = 0; i < front.rgba.size(); i += 4) {
        const double left = 1 - front.rgba[i + 3];
        for (std::size_t channel = 0; channel < 4; ++channel)
            front.rgba[i + channel] += left * double{picture.rgba[i + channel]};
    }
}

}  // namespace lamina
