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

// How a picture A differs from a picture B: e = A - B in units of 1/255.
struct PictureComparison {
    std::vector<std::string> channels;  // R, G, B, A; of PNG files what they have
    std::vector<ErrorNorms> of_channel;
    ErrorNorms all;
    // Where |e| is largest: the first such component.
    int column = 0, row = 0;
    std::size_t channel = 0;  // index into `channels`
};

// Throws Error where the sizes differ or a number is none.
LAMINA_API PictureComparison compare(const PreciseImage& a, const PreciseImage& b);
// EXR and NPY files with each other, PNG with PNG as stored codes; otherwise the same.
LAMINA_API PictureComparison compare_files(const std::filesystem::path& a,
                                           const std::filesystem::path& b);

// The bytes of a PNG file: the largest difference of each pixel's channels in false colour, from
// -range (dark blue) over 0 (white) to range (dark red), in 1/255, over a colour bar.
LAMINA_API std::string difference_png(const PreciseImage& a, const PreciseImage& b, double range);

// The false colours in which difference_png() shows these differences, in 1/255, red, green and
// blue of each: for a screen. Throws Error where one of them is none, or the range not above 0.
LAMINA_API std::vector<std::uint8_t> difference_codes(std::span<const float> differences,
                                                      double range);

struct LoadedPicture {
    PreciseImage image;
    std::optional<ImageColorSpace> space;  // where the file says it: EXR
};

// Reads an EXR or NPY file. Throws Error.
LAMINA_API LoadedPicture load_picture(const std::filesystem::path& file);

}  // namespace lamina
