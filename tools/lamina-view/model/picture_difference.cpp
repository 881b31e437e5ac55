// SPDX-License-Identifier: Apache-2.0
#include "model/picture_difference.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace lamina::view {

float largest_difference(const float* a, const float* b) {
    float largest = 0;
    for (int channel = 0; channel < 4; ++channel) {
        const float e = 255 * (a[channel] - b[channel]);
        if (std::abs(e) > std::abs(largest)) largest = e;
    }
    return largest;
}

PictureDifference difference_of(const Image& a, const Image& b) {
    assert(a.width == b.width && a.height == b.height);
    PictureDifference difference{a.width, a.height, std::vector<float>(a.rgba.size() / 4)};
    for (std::size_t pixel = 0; pixel < difference.e.size(); ++pixel)
        difference.e[pixel] = largest_difference(&a.rgba[4 * pixel], &b.rgba[4 * pixel]);
    return difference;
}

double fitting_range(const PictureDifference& difference) {
    double largest = 0;
    for (const float e : difference.e)
        if (!std::isnan(e)) largest = std::max(largest, std::abs(static_cast<double>(e)));
    if (largest <= smallest_range) return smallest_range;
    const double power = std::pow(10, std::floor(std::log10(largest)));
    for (const double step : {1., 2., 5.})
        if (largest <= step * power) return step * power;
    return 10 * power;
}

}  // namespace lamina::view
