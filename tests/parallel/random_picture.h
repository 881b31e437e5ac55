// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <random>

#include "lamina/image.h"

namespace lamina {

// Returns a picture of alternating runs of pixels that show nothing and that show colours up to
// `largest`.
inline Image random_picture(int width, int height, std::uint32_t seed, float largest = 1) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> uniform(0, 1);
    Image picture(width, height);
    bool shows = false;
    for (std::size_t i = 0; i < picture.rgba.size(); i += 4) {
        if (uniform(random) < .1f) shows = !shows;
        if (!shows) continue;
        const float opacity = uniform(random) < .2f ? 1 : uniform(random);
        for (std::size_t channel = 0; channel < 3; ++channel)
            picture.rgba[i + channel] = opacity * largest * uniform(random);
        picture.rgba[i + 3] = opacity;
    }
    return picture;
}

}  // namespace lamina
