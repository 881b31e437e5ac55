// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "lamina/export.h"
#include "lamina/image.h"
#include "lamina/image_color_space.h"

namespace lamina {

// Writes a picture, which appears under its name when it is complete. The suffix decides: .png is
// for looking at (over `background`; 8 bits, sRGB); .exr and .npy (NumPy's, of shape (height,
// width, 4)) keep every number as 32-bit float. `space` is that of picture and background, as in
// the scene (Scene::color_space). `attributes` are texts by name that .exr has beside the pixels.
// Throws Error for other suffixes and if the file cannot be written.
LAMINA_API void save_picture(const Image& picture, const std::filesystem::path& file,
                             const glm::dvec3& background = glm::dvec3(0),
                             ImageColorSpace space = ImageColorSpace::linear,
                             const std::map<std::string, std::string>& attributes = {});
// Writes a traced picture: .npy keeps double precision, the others have its numbers as float32.
LAMINA_API void save_picture(const PreciseImage& picture, const std::filesystem::path& file,
                             const glm::dvec3& background = glm::dvec3(0),
                             ImageColorSpace space = ImageColorSpace::linear,
                             const std::map<std::string, std::string>& attributes = {});

// Returns the bytes of the PNG file.
LAMINA_API std::string picture_png(const Image& picture,
                                   const glm::dvec3& background = glm::dvec3(0),
                                   ImageColorSpace space = ImageColorSpace::linear);
// Returns the codes of the PNG file's pixels, red, green and blue, row 0 on top: for a screen.
LAMINA_API std::vector<std::uint8_t> screen_codes(const Image& picture,
                                                  const glm::dvec3& background = glm::dvec3(0),
                                                  ImageColorSpace space = ImageColorSpace::linear);

}  // namespace lamina
