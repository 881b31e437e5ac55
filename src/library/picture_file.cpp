// SPDX-License-Identifier: Apache-2.0
#include "lamina/picture_file.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "image/picture.h"

namespace lamina {

void save_picture(const Image& picture, const std::filesystem::path& file,
                  const glm::dvec3& background, ImageColorSpace space) {
    const std::string suffix = file.extension().string();
    if (suffix != ".png" && suffix != ".exr" && suffix != ".npy")
        fail("{}: found the suffix \"{}\", expected .png, .exr or .npy", file.string(), suffix);
    AtomicFile output(file);
    write_picture(output, picture, background, {}, space);
    output.commit();
}

}  // namespace lamina
