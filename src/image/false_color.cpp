// SPDX-License-Identifier: Apache-2.0
#include "image/false_color.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lamina {
namespace {

using Rgb = std::array<int, 3>;

// The diverging scheme RdBu of ColorBrewer (Brewer, Harrower), which stays legible with every
// common colour-vision deficiency. Its middle is made pure white. The colours run from 0 outwards
// at equal steps.
constexpr std::array<Rgb, 6> blues = {{{255, 255, 255},
                                       {209, 229, 240},
                                       {146, 197, 222},
                                       {67, 147, 195},
                                       {33, 102, 172},
                                       {5, 48, 97}}};
constexpr std::array<Rgb, 6> reds = {{{255, 255, 255},
                                      {253, 219, 199},
                                      {244, 165, 130},
                                      {214, 96, 77},
                                      {178, 24, 43},
                                      {103, 0, 31}}};

}  // namespace

std::array<std::uint16_t, 3> false_color_of(double share) {
    const std::array<Rgb, 6>& steps = share < 0 ? blues : reds;
    const double position = 5 * std::abs(share);
    const std::size_t lower = std::min<std::size_t>(static_cast<std::size_t>(position), 4);
    const double between = position - static_cast<double>(lower);
    std::array<std::uint16_t, 3> mixed{};
    for (std::size_t i = 0; i < 3; ++i) {
        mixed[i] = static_cast<std::uint16_t>(
            std::lround((1 - between) * steps[lower][i] + between * steps[lower + 1][i]));
    }
    return mixed;
}

CodedImage false_color(const Difference& difference, double scale) {
    CodedImage picture(difference.width, difference.height, 3, 8);
    const auto channels = static_cast<std::ptrdiff_t>(difference.channels.size());
    auto code = picture.codes.begin();
    for (auto e = difference.e.begin(); e != difference.e.end(); e += channels) {
        const double largest = *std::max_element(
            e, e + channels, [](double a, double b) { return std::abs(a) < std::abs(b); });
        const double share = largest == 0 ? 0 : std::clamp(largest / scale, -1.0, 1.0);
        for (const std::uint16_t component : false_color_of(share)) *code++ = component;
    }
    return picture;
}

}  // namespace lamina
