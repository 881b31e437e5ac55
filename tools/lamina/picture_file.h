// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <glm/vec3.hpp>
#include <map>
#include <string>

#include "base/atomic_file.h"
#include "lamina/image.h"
#include "lamina/image_color_space.h"

namespace lamina {

using PictureAttributes = std::map<std::string, std::string>;  // of an EXR file

// The picture that `render -o` writes: .exr, .png or .npy by the file's suffix. Made before
// rendering begins, so that a path that cannot be written fails at once.
class PictureFile {
  public:
    // `precise`: a double-precision image will come, which .npy needs. Throws UsageError for a bad
    // suffix.
    PictureFile(const std::filesystem::path& path, bool precise);

    // `space`: of image and background. Returns how many pixels had to be clamped (PNG).
    std::size_t write(const Image& image, const glm::dvec3& background,
                      const PictureAttributes& attributes, ImageColorSpace space);
    std::size_t write(const PreciseImage& image, const glm::dvec3& background,
                      const PictureAttributes& attributes, ImageColorSpace space);

  private:
    std::string suffix_;
    AtomicFile file_;
};

}  // namespace lamina
