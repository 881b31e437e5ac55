// SPDX-License-Identifier: Apache-2.0
#include "volume/middle_slices.h"

#include <fmt/format.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "volume/volume_store.h"

namespace lamina {
namespace {

constexpr int room = 8;  // pixels around slices
constexpr int letter_dot = 2, title_high = (text_dots_high + 3) * letter_dot;
constexpr double fewest_pixels = 256, most_pixels = 1024;  // along the longest axis
constexpr double share_of_rounding = 1e-9;  // relative error of a length that is ignored
constexpr PixelColor no_value{20, 40, 160}, paper{255, 255, 255}, ink{40, 40, 40};

struct Slice {
    std::size_t right, up, across;  // axes: to the right and up in the picture, and its normal
};
constexpr std::array<Slice, 3> slice_axes{{{0, 1, 2}, {0, 2, 1}, {1, 2, 0}}};

PixelColor grey(double value, const ValueRange& range) {
    if (!std::isfinite(value)) return no_value;
    const double share = range.lo < range.hi ? (value - range.lo) / (range.hi - range.lo) : 0.5;
    const auto code = static_cast<std::uint16_t>(std::floor(255 * share + 0.5));
    return {code, code, code};
}

// Returns the number of pixels for each axis of the volume (middle_slices()).
std::array<int, 3> pixels_of(const Grid& grid) {
    std::array<double, 3> spacing{}, length{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        spacing[axis] = glm::length(grid.step[axis]);
        length[axis] = spacing[axis] * static_cast<double>(grid.size[axis]);
    }
    const double whole = *std::max_element(length.begin(), length.end());
    double per_length = 1 / *std::min_element(spacing.begin(), spacing.end());
    per_length *=
        std::max(1.0, std::ceil(fewest_pixels / (whole * per_length) - share_of_rounding));
    per_length = std::min(per_length, most_pixels / whole);
    std::array<int, 3> pixels{};
    for (std::size_t axis = 0; axis < 3; ++axis)
        pixels[axis] = std::max(1, static_cast<int>(std::lround(per_length * length[axis])));
    return pixels;
}

std::string title_of(const Slice& slice, const Grid& grid) {
    constexpr const char* names = "xyz";
    return fmt::format("{}{}, {}={}", names[slice.right], names[slice.up], names[slice.across],
                       grid.size[slice.across] / 2);
}

// Draws a slice with its bottom left pixel at (left, bottom).
template <typename Samples>
void draw_slice(const Grid& grid, const Samples& samples, const ValueRange& range,
                const Slice& slice, const std::array<int, 3>& pixels, int left, int bottom,
                CodedImage& image) {
    std::array<std::int64_t, 3> index{grid.size[0] / 2, grid.size[1] / 2, grid.size[2] / 2};
    const auto nearest = [&](std::size_t axis, std::int64_t pixel) {
        return (2 * pixel + 1) * grid.size[axis] / (2 * pixels[axis]);
    };
    for (int v = 0; v < pixels[slice.up]; ++v) {
        index[slice.up] = nearest(slice.up, v);
        for (int u = 0; u < pixels[slice.right]; ++u) {
            index[slice.right] = nearest(slice.right, u);
            const auto sample = static_cast<double>(
                samples[(index[2] * grid.size[1] + index[1]) * grid.size[0] + index[0]]);
            fill_rectangle(image, left + u, bottom - v, 1, 1, grey(sample, range));
        }
    }
}

}  // namespace

CodedImage middle_slices(const Volume& volume, const ValueRange& range) {
    const Grid& grid = volume.grid();
    const std::array<int, 3> pixels = pixels_of(grid);
    std::array<int, 3> left{};
    int width = room;
    for (std::size_t i = 0; i < slice_axes.size(); ++i) {
        left[i] = width;
        width += room + std::max(pixels[slice_axes[i].right],
                                 text_width(title_of(slice_axes[i], grid), letter_dot));
    }
    const int bottom = room + title_high + std::max(pixels[1], pixels[2]) - 1;
    CodedImage image(width, bottom + 1 + room, 3, 8);
    fill_rectangle(image, 0, 0, image.width, image.height, paper);
    for (std::size_t i = 0; i < slice_axes.size(); ++i) {
        draw_text(image, left[i], room, title_of(slice_axes[i], grid), letter_dot, ink);
        visit_samples(volume, [&](const auto& samples) {
            draw_slice(grid, samples, range, slice_axes[i], pixels, left[i], bottom, image);
        });
    }
    return image;
}

}  // namespace lamina
