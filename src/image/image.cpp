// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "base/enum_words.h"
#include "lamina/image.h"
#include "lamina/image_color_space.h"

namespace lamina {

Image to_float(const PreciseImage& image) {
    Image rounded(image.width, image.height);
    std::transform(image.rgba.begin(), image.rgba.end(), rounded.rgba.begin(),
                   [](double value) { return static_cast<float>(value); });
    return rounded;
}

PreciseImage to_double(const Image& image) {
    PreciseImage precise(image.width, image.height);
    precise.rgba.assign(image.rgba.begin(), image.rgba.end());
    return precise;
}

const char* name_of(ImageColorSpace space) {
    return word_of(space, {"linear", "display"});
}

}  // namespace lamina
