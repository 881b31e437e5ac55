// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <variant>

#include "image/coded_image.h"
#include "image/difference.h"
#include "lamina/image.h"

namespace lamina {

// A picture from a file of any kind that this room reads.
struct LoadedImage {
    std::string name;  // of the file
    std::variant<Image, PreciseImage, CodedImage> pixels;
};

// By suffix: .exr, .npy, .png (of any case). Throws Error for other suffixes, bad files, and
// components that are not finite.
LoadedImage load_image(const std::filesystem::path& path);

// EXR and NPY against each other, PNG against PNG as stored codes. Throws Error, with the names of
// the files, when the two are not of one kind or one size.
Difference difference(const LoadedImage& a, const LoadedImage& b);

}  // namespace lamina
