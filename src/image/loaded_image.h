// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>

#include "image/coded_image.h"
#include "image/difference.h"
#include "lamina/image.h"
#include "lamina/image_color_space.h"

namespace lamina {

// A picture from a file of any kind that this room reads.
struct LoadedImage {
    std::string name;  // of the file
    std::variant<Image, PreciseImage, CodedImage> pixels;
    std::optional<ImageColorSpace> space;  // where the file says it: EXR
};

// Loads a picture; the suffix (.exr, .npy or .png, of any case) gives its kind. Throws Error for
// other suffixes, bad files, and components that are not finite.
LoadedImage load_image(const std::filesystem::path& path);

// Compares EXR and NPY with each other, and PNG with PNG as stored codes. Throws Error, with the
// names of the files, where they differ in kind or size, or one is known to hold linear light and
// the other display values.
Difference difference(const LoadedImage& a, const LoadedImage& b);

}  // namespace lamina
