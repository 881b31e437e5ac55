// SPDX-License-Identifier: Apache-2.0
#include "image/picture.h"

#include "image/exr.h"
#include "image/png.h"

namespace lamina {

std::size_t write_picture(AtomicFile& file, const Image& image, const glm::dvec3& background,
                          const std::map<std::string, std::string>& attributes,
                          ImageColorSpace space) {
    if (file.path().extension() == ".png") return write_png(file, image, background, space);
    write_exr(file, image, attributes, space);
    return 0;
}

}  // namespace lamina
