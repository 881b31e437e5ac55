// SPDX-License-Identifier: Apache-2.0
#include "volume/middle_slices.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "image/image_limits.h"

namespace lamina {
namespace {

constexpr std::int64_t room = 8;  // pixels between slices

using Color = std::array<std::uint16_t, 3>;
constexpr Color no_value{20, 40, 160};

Color grey(double value, const ValueRange& range) {
    if (!std::isfinite(value)) return no_value;
    const double share = range.lo < range.hi ? (value - range.lo) / (range.hi - range.lo) : 0.5;
    const auto code = static_cast<std::uint16_t>(std::floor(255 * share + 0.5));
    return {code, code, code};
}

// Draws the slice through `middle` that spans axes `right` and `up`, its bottom left pixel at
// (left, height - 1).
template <typename T>
void draw_slice(const Grid& grid, const T* samples, const ValueRange& range, std::size_t right,
                std::size_t up, std::int64_t left, CodedImage& image) {
    std::array<std::int64_t, 3> index{grid.size[0] / 2, grid.size[1] / 2, grid.size[2] / 2};
    for (std::int64_t v = 0; v < grid.size[up]; ++v) {
        for (std::int64_t u = 0; u < grid.size[right]; ++u) {
            index[right] = u;
            index[up] = v;
            const auto sample = static_cast<double>(
                samples[(index[2] * grid.size[1] + index[1]) * grid.size[0] + index[0]]);
            const Color color = grey(sample, range);
            const std::int64_t pixel = (image.height - 1 - v) * image.width + left + u;
            std::copy(color.begin(), color.end(),
                      &image.codes[static_cast<std::size_t>(3 * pixel)]);
        }
    }
}

}  // namespace

CodedImage middle_slices(const Volume& volume, const ValueRange& range) {
    // Clang before version 16 cannot capture structured bindings in lambdas.
    const std::int64_t nx = volume.grid().size[0];
    const std::int64_t ny = volume.grid().size[1], nz = volume.grid().size[2];
    const std::int64_t width = nx + room + nx + room + ny;
    const std::int64_t height = std::max(ny, nz);
    check_image_size("the picture of the slices", width, height);
    CodedImage image(static_cast<int>(width), static_cast<int>(height), 3, 8);
    for (std::size_t i = 0; i < image.codes.size(); ++i) image.codes[i] = no_value[i % 3];
    volume.visit([&](const auto* samples) {
        const Grid& grid = volume.grid();
        draw_slice(grid, samples, range, 0, 1, 0, image);
        draw_slice(grid, samples, range, 0, 2, nx + room, image);
        draw_slice(grid, samples, range, 1, 2, 2 * (nx + room), image);
    });
    return image;
}

}  // namespace lamina
