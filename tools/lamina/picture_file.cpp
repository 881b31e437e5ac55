// SPDX-License-Identifier: Apache-2.0
#include "picture_file.h"

#include "base/error.h"
#include "image/npy.h"
#include "image/picture.h"

namespace lamina {
namespace {

std::string checked_suffix(const std::filesystem::path& path, bool precise) {
    const std::string suffix = path.extension().string();
    if (suffix == ".npy" && !precise) {
        throw UsageError(fmt::format(
            "-o {}: .npy holds double precision, which only the method trace gives; expected "
            ".exr or .png",
            path.string()));
    }
    if (suffix != ".exr" && suffix != ".png" && suffix != ".npy") {
        throw UsageError(fmt::format("-o {}: found the suffix \"{}\", expected .exr, .png or .npy",
                                     path.string(), suffix));
    }
    return suffix;
}

}  // namespace

PictureFile::PictureFile(const std::filesystem::path& path, bool precise)
    : suffix_(checked_suffix(path, precise)), file_(path) {}

std::size_t PictureFile::write(const Image& image, const glm::dvec3& background,
                               const PictureAttributes& attributes, ImageColorSpace space) {
    const std::size_t clamped = write_picture(file_, image, background, attributes, space);
    file_.commit();
    return clamped;
}

std::size_t PictureFile::write(const PreciseImage& image, const glm::dvec3& background,
                               const PictureAttributes& attributes, ImageColorSpace space) {
    if (suffix_ != ".npy") return write(to_float(image), background, attributes, space);
    write_npy(file_, image);
    file_.commit();
    return 0;
}

}  // namespace lamina
