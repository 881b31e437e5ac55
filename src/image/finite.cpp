// SPDX-License-Identifier: Apache-2.0
#include "image/finite.h"

#include <cmath>
#include <limits>

#include "base/error.h"

namespace lamina {

template <typename Real>
void require_finite(const std::string& name, const RgbaImage<Real>& image) {
    constexpr Real largest = std::numeric_limits<float>::max();
    for (std::size_t i = 0; i < image.rgba.size(); ++i) {
        if (std::abs(image.rgba[i]) <= largest) continue;  // false for NaN
        const std::size_t pixel = i / 4;
        const auto width = static_cast<std::size_t>(image.width);
        fail("{}: pixel ({}, {}), channel {}, is {}; expected a finite float32 number", name,
             pixel % width, pixel / width, "RGBA"[i % 4], image.rgba[i]);
    }
}

template void require_finite(const std::string&, const Image&);
template void require_finite(const std::string&, const PreciseImage&);

}  // namespace lamina
