// SPDX-License-Identifier: Apache-2.0
#include "image/srgb.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace lamina {
namespace {

long code_of_linear(double linear) {
    return std::lround(255 * srgb_from_linear(linear));
}

// Table of the codes of linear light 0..1, which saves a power for each: the number at which each
// code begins, and the first code in each of 4096 equal cells.
class CodeSteps {
  public:
    CodeSteps() {
        for (std::size_t code = 0; code < begins_.size(); ++code)
            begins_[code] = begin_of(static_cast<long>(code));
        for (std::size_t cell = 0; cell < cells; ++cell)
            first_[cell] = static_cast<std::uint16_t>(
                code_of_linear(static_cast<double>(cell) / static_cast<double>(cells)));
    }

    // A cell has two codes at most: the curve is steepest at 0, and there a code is 1.2 cells wide.
    std::uint16_t code_of(double linear) const {
        const auto cell =
            std::min(static_cast<std::size_t>(linear * static_cast<double>(cells)), cells - 1);
        const std::uint16_t code = first_[cell];
        return code < 255 && linear >= begins_[code + 1u] ? static_cast<std::uint16_t>(code + 1)
                                                          : code;
    }

  private:
    static constexpr std::size_t cells = 4096;

    // Returns the least number with this code or a higher one.
    static double begin_of(long code) {
        double below = 0, there = 1;
        if (code == 0) return 0;
        while (std::nextafter(below, 1) < there) {
            const double middle = std::midpoint(below, there);
            (code_of_linear(middle) >= code ? there : below) = middle;
        }
        return there;
    }

    std::array<double, 256> begins_{};
    std::array<std::uint16_t, cells> first_{};
};

}  // namespace

double srgb_from_linear(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

double linear_from_srgb(double stored) {
    return stored <= 0.04045 ? stored / 12.92 : std::pow((stored + 0.055) / 1.055, 2.4);
}

std::uint16_t display_code(double value, ImageColorSpace space) {
    const double shown = std::clamp(value, 0.0, 1.0);
    if (space == ImageColorSpace::display)
        return static_cast<std::uint16_t>(std::lround(255 * shown));
    static const CodeSteps steps;
    return steps.code_of(shown);
}

}  // namespace lamina
