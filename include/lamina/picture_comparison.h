// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lamina/error_norms.h"
#include "lamina/export.h"
#include "lamina/image.h"
#include "lamina/image_color_space.h"

namespace lamina {

// Difference of a picture A from a picture B: e = A - B in units of 1/255.
struct PictureComparison {
    std::vector<std::string> channels;  // R, G, B, A; for PNG files those that they have
    std::vector<ErrorNorms> of_channel;
    ErrorNorms all;
    // Pixel and channel of the largest |e|, the first if there are several.
    int column = 0, row = 0;
    std::size_t channel = 0;  // index into `channels`
};

// Throws Error if the sizes differ or a number is NaN or infinite.
LAMINA_API PictureComparison compare(const PreciseImage& a, const PreciseImage& b);
// Compares EXR and NPY files with each other, or PNG files by their stored codes.
LAMINA_API PictureComparison compare_files(const std::filesystem::path& a,
                                           const std::filesystem::path& b);

// Returns the bytes of a PNG file that shows the largest difference of each pixel's channels in
// false colour, from -range (dark blue) over 0 (white) to range (dark red), in 1/255, over a colour
// bar.
LAMINA_API std::string difference_png(const PreciseImage& a, const PreciseImage& b, double range);

// Returns the false colours in which difference_png() shows these differences (in 1/255): codes of
// red, green and blue for each. Throws Error if a difference is NaN or infinite, or if the range is
// not above 0.
LAMINA_API std::vector<std::uint8_t> difference_codes(std::span<const float> differences,
                                                      double range);

struct LoadedPicture {
    PreciseImage image;
    std::optional<ImageColorSpace> space;  // known only for EXR files
};

// Reads an EXR or NPY file. Throws Error.
LAMINA_API LoadedPicture load_picture(const std::filesystem::path& file);

}  // namespace lamina
