// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lamina/error.h"

namespace lamina {

// Colour space of the numbers in which a picture is composited. linear: linear light. display: the
// values that a screen gets, code / 255 of sRGB, as VTK and ParaView composite them.
enum class ImageColorSpace { linear, display };

LAMINA_API const char* name_of(ImageColorSpace space);

// An image of associated (premultiplied) RGBA before any background. Row 0 is the top. Pixels are
// stored row by row, four numbers each.
template <typename Real>
struct RgbaImage {
    int width = 0;
    int height = 0;
    std::vector<Real> rgba;
    ImageColorSpace space = ImageColorSpace::linear;  // Scene::color_space of the scene it shows

    RgbaImage() = default;
    RgbaImage(int width_pixels, int height_pixels)
        : width(width_pixels),
          height(height_pixels),
          rgba(4 * static_cast<std::size_t>(width_pixels) *
               static_cast<std::size_t>(height_pixels)) {}

    // Sets the size; keeps the memory if it suffices. The numbers are undefined afterwards.
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

// A rectangle of pixels; row 0 is the top.
struct PictureTile {
    int column = 0, row = 0;  // upper left pixel
    int width = 0, height = 0;
};

// How a PNG file shows a picture: over a background or, if it is transparent, without one and with
// straight alpha (colours divided by the opacity).
struct PngLook {
    glm::dvec3 background;  // numbers in the picture's space
    bool transparent;
    int bits;  // of a code: 8 or 16

    PngLook(const glm::dvec3& behind = glm::dvec3(0), bool has_alpha = false, int bits_of_code = 8)
        : background(behind), transparent(has_alpha), bits(bits_of_code) {}
};

// Writes a picture, which appears under its name when it is complete. The suffix decides on the
// format: .png is for looking at (sRGB codes, as `look` says); .exr and .npy (NumPy's, of shape
// (height, width, 4)) keep every number as 32-bit float. `attributes`: texts by name that .exr
// stores beside the pixels. Throws Error for other suffixes and if the file cannot be written.
LAMINA_API void save_picture(const Image& picture, const std::filesystem::path& file,
                             const PngLook& look = {},
                             const std::map<std::string, std::string>& attributes = {});
// Writes a traced picture: .npy keeps double precision, .exr has float32.
LAMINA_API void save_picture(const PreciseImage& picture, const std::filesystem::path& file,
                             const PngLook& look = {},
                             const std::map<std::string, std::string>& attributes = {});

// Returns the bytes of the PNG file that save_picture() writes.
LAMINA_API std::string picture_png(const Image& picture, const PngLook& look = {});
// Returns 8-bit codes over a background, red, green and blue, row 0 on top, to show on a screen.
LAMINA_API std::vector<std::uint8_t> screen_codes(const Image& picture,
                                                  const glm::dvec3& background = glm::dvec3(0));

// Norms of the error e of a picture, over pixels and channels, in units of 1/255
// (docs/numerics.md).
struct ErrorNorms {
    double linf = 0;  // largest |e|
    // Mean of e, with its sign. Files and the command line call it `l1`, as LaMar's Table 4 does.
    double mean = 0;
    double l2 = 0;  // root of the mean of e^2
};

// Measures a picture against the truth, over all pixels and channels (red, green, blue, opacity).
// Throws Error if their sizes or colour spaces differ or a number is NaN or infinite.
LAMINA_API ErrorNorms error_of(const Image& picture, const Image& truth);
LAMINA_API ErrorNorms error_of(const Image& picture, const PreciseImage& truth);

// Difference of a picture A from a picture B: e = A - B in units of 1/255.
struct PictureComparison {
    std::vector<std::string> channels;  // R, G, B, A; for PNG files the channels of the files
    std::vector<ErrorNorms> of_channel;
    ErrorNorms all;
    // Pixel and channel of the largest |e|, the first if there are several.
    int column = 0, row = 0;
    std::size_t channel = 0;  // index into `channels`
};

// Throws Error if the sizes or colour spaces differ or a number is NaN or infinite.
LAMINA_API PictureComparison compare(const PreciseImage& a, const PreciseImage& b);
// Compares two EXR or NPY files, or two PNG files by their stored codes.
LAMINA_API PictureComparison compare_files(const std::filesystem::path& a,
                                           const std::filesystem::path& b);

// Returns the bytes of a PNG file that shows, for each pixel, the difference a - b of the channel
// in which it is largest, in false colour from -range (dark blue) over 0 (white) to range (dark
// red), in 1/255, with a colour bar below. Throws Error if the range is not finite and above 0, or
// if the sizes differ.
LAMINA_API std::string difference_png(const PreciseImage& a, const PreciseImage& b, double range);

// Returns the false colours in which difference_png() shows these differences (in 1/255): codes of
// red, green and blue for each. Throws Error if a difference is NaN, or if the range is not finite
// and above 0.
LAMINA_API std::vector<std::uint8_t> difference_codes(std::span<const float> differences,
                                                      double range);

// A picture that was read from a file.
struct LoadedPicture {
    PreciseImage image;                    // image.space is linear if the file does not say
    std::optional<ImageColorSpace> space;  // known only for EXR files
};

// Reads an EXR or NPY file, or a PNG file with alpha, whose codes become associated linear light.
// Throws Error.
LAMINA_API LoadedPicture load_picture(const std::filesystem::path& file);

}  // namespace lamina
