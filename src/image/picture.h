// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <cstddef>
#include <map>
#include <string>

#include "base/output_file.h"
#include "lamina/image.h"

namespace lamina {

// Writes a PNG file (image/png.h) where the suffix is .png, NumPy's (image/npy.h) where it is .npy,
// else an EXR file (image/exr.h) with the attributes. Returns how many pixels were clamped. The
// caller commits the file.
std::size_t write_picture(OutputFile& file, const Image& image, const glm::dvec3& background,
                          const std::map<std::string, std::string>& attributes);

}  // namespace lamina
