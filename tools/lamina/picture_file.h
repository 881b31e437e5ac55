// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>
#include <map>
#include <memory>
#include <string>

#include "base/output_file.h"
#include "lamina/image.h"
#include "lamina/image_color_space.h"
#include "picture_format.h"

namespace lamina {

using PictureAttributes = std::map<std::string, std::string>;  // of an EXR file

// A picture that `render -o` writes: a file, or stdout for "-". Made before rendering begins, so
// that a path that cannot be written fails at once.
class PictureFile {
  public:
    // Throws Error, and UsageError if stdout is a terminal.
    PictureFile(const std::string& output, PictureFormat format);

    // `space`: of image and background. Returns how many pixels had to be clamped (PNG).
    std::size_t write(const Image& image, const glm::dvec3& background,
                      const PictureAttributes& attributes, ImageColorSpace space);
    // Writes a picture in double precision, which NPY keeps.
    std::size_t write(const PreciseImage& image, const glm::dvec3& background,
                      const PictureAttributes& attributes, ImageColorSpace space);

  private:
    PictureFormat format_;
    std::unique_ptr<OutputFile> file_;
};

}  // namespace lamina
