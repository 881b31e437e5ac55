// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "lamina/export.h"

namespace lamina {

// An image of associated (premultiplied) RGBA before any background, in linear light unless
// Scene::color_space says otherwise. Row 0 is the top. Pixels are stored row by row, four numbers
// each.
template <typename Real>
struct RgbaImage {
    int width = 0;
    int height = 0;
    std::vector<Real> rgba;

    RgbaImage() = default;
    RgbaImage(int width_pixels, int height_pixels)
        : width(width_pixels),
          height(height_pixels),
          rgba(4 * static_cast<std::size_t>(width_pixels) *
               static_cast<std::size_t>(height_pixels)) {}

    // Keeps its memory if that suffices; all numbers lose their meaning.
    void resize(int width_pixels, int height_pixels) {
        width = width_pixels;
        height = height_pixels;
        rgba.resize(4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    }

    Real* pixel(int column, int row) { return rgba.data() + offset(column, row); }
    const Real* pixel(int column, int row) const { return rgba.data() + offset(column, row); }

  private:
    std::size_t offset(int column, int row) const {
        return 4 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
                    static_cast<std::size_t>(column));
    }
};

using Image = RgbaImage<float>;          // what renderers write
using PreciseImage = RgbaImage<double>;  // what the reference tracer writes

LAMINA_API Image to_float(const PreciseImage& image);
// Returns the same numbers in double precision.
LAMINA_API PreciseImage to_double(const Image& image);

}  // namespace lamina
