// SPDX-License-Identifier: Apache-2.0
#include "lamina/image.h"

#include <algorithm>

namespace lamina {

Image to_float(const PreciseImage& image) {
    Image rounded(image.width, image.height);
    std::transform(image.rgba.begin(), image.rgba.end(), rounded.rgba.begin(),
                   [](double value) { return static_cast<float>(value); });
    return rounded;
}

}  // namespace lamina
