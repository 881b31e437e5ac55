// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <cstddef>
#include <map>
#include <string>

#include "base/output_file.h"
#include "lamina/image.h"
#include "lamina/image_color_space.h"

namespace lamina {

// Writes a PNG file (image/png.h) where the suffix is .png, NumPy's (image/npy.h) where it is .npy,
// else an EXR file (image/exr.h) with the attributes. `space`: of image and background. Returns how
// many pixels were clamped. The caller commits the file.
std::size_t write_picture(OutputFile& file, const Image& image, const glm::dvec3& background,
                          const std::map<std::string, std::string>& attributes,
                          ImageColorSpace space = ImageColorSpace::linear);

}  // namespace lamina
