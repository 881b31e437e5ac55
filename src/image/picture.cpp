// SPDX-License-Identifier: Apache-2.0
#include "image/picture.h"

#include "image/exr.h"
#include "image/npy.h"
#include "image/png.h"

namespace lamina {

std::size_t write_picture(OutputFile& file, const Image& image, const glm::dvec3& background,
                          const std::map<std::string, std::string>& attributes,
                          ImageColorSpace space) {
    const std::filesystem::path suffix = file.path().extension();
    if (suffix == ".png") return write_png(file, image, background, space);
    if (suffix == ".npy")
        write_npy(file, image);
    else
        write_exr(file, image, attributes, space);
    return 0;
}

}  // namespace lamina
