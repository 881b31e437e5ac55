// SPDX-License-Identifier: Apache-2.0
#include "lamina/picture_file.h"

#include "base/error.h"
#include "base/output_file.h"
#include "image/npy.h"
#include "image/picture.h"
#include "image/png.h"

namespace lamina {

void save_picture(const Image& picture, const std::filesystem::path& file,
                  const glm::dvec3& background, ImageColorSpace space,
                  const std::map<std::string, std::string>& attributes) {
    const std::string suffix = file.extension().string();
    if (suffix != ".png" && suffix != ".exr" && suffix != ".npy")
        fail("{}: found the suffix \"{}\", expected .png, .exr or .npy", file.string(), suffix);
    AtomicFile output(file);
    write_picture(output, picture, background, attributes, space);
    output.commit();
}

void save_picture(const PreciseImage& picture, const std::filesystem::path& file,
                  const glm::dvec3& background, ImageColorSpace space,
                  const std::map<std::string, std::string>& attributes) {
    if (file.extension() != ".npy")
        return save_picture(to_float(picture), file, background, space, attributes);
    AtomicFile output(file);
    write_npy(output, picture);
    output.commit();
}

std::string picture_png(const Image& picture, const glm::dvec3& background, ImageColorSpace space) {
    return encode_png(picture, background, space);
}

std::vector<std::uint8_t> screen_codes(const Image& picture, const glm::dvec3& background,
                                       ImageColorSpace space) {
    return png_codes(picture, background, space);
}

}  // namespace lamina
