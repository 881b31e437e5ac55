// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <variant>

#include "base/output_file.h"
#include "image/coded_image.h"
#include "image/difference.h"
#include "lamina/image.h"

namespace lamina {

// A picture that was read from an EXR, NPY or PNG file.
struct LoadedImage {
    std::string name;  // name of the file
    std::variant<Image, PreciseImage, CodedImage> pixels;
    std::optional<ImageColorSpace> space;  // given for EXR files only
};

// Returns the suffix of a file's name in lower case, as ".png"; empty if it has none.
std::string lower_suffix(const std::filesystem::path& path);

// Says why pictures are not written with this suffix, and which ones they may have.
std::string refusal_of_suffix(const std::string& suffix);

// Loads .exr, .npy or .png (any case). Throws Error for others, bad files, non-finite components.
LoadedImage load_image(const std::filesystem::path& path);

// Compares EXR and NPY with each other, and PNG with PNG as codes. Throws Error, which names the
// files, if the pictures differ in kind, in size or, if both are known, in colour space.
Difference difference(const LoadedImage& a, const LoadedImage& b);

// Writes PNG or NPY by the suffix (.png, .npy), else EXR with the attributes. `space`: of image and
// look. Returns how many pixels were clamped. The caller commits the file.
std::size_t write_picture(OutputFile& file, const Image& image, const PngLook& look,
                          const std::map<std::string, std::string>& attributes,
                          ImageColorSpace space = ImageColorSpace::linear);

}  // namespace lamina
