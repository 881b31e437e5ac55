// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <variant>

#include <glm/vec3.hpp>
#include "base/output_file.h"
#include "image/coded_image.h"
#include "image/difference.h"
#include "lamina/image.h"

namespace lamina {

// A picture from a file of any kind that this module reads.
struct LoadedImage {
    std::string name;  // name of the file
    std::variant<Image, PreciseImage, CodedImage> pixels;
    std::optional<ImageColorSpace> space;  // only EXR files say it
};

// Loads a picture; the suffix (.exr, .npy or .png, of any case) gives its kind. Throws Error for
// other suffixes, bad files, and components that are not finite.
LoadedImage load_image(const std::filesystem::path& path);

// Compares EXR and NPY with each other, and PNG with PNG as codes. Throws Error, with the names of
// the files, if they differ in kind, in size or, as far as it is known, in colour space.
Difference difference(const LoadedImage& a, const LoadedImage& b);

// Writes PNG or NPY by the suffix (.png, .npy), else EXR with the attributes. `space`: that of
// image and background. Returns how many pixels were clamped. The caller commits the file.
std::size_t write_picture(OutputFile& file, const Image& image, const glm::dvec3& background,
                          const std::map<std::string, std::string>& attributes,
                          ImageColorSpace space = ImageColorSpace::linear);

}  // namespace lamina
