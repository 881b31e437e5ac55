// SPDX-License-Identifier: Apache-2.0
#include "picture_file.h"

#include <unistd.h>

#include "base/error.h"
#include "image/exr.h"
#include "image/npy.h"
#include "image/png.h"
#include "named_output.h"

namespace lamina {
namespace {

std::unique_ptr<OutputFile> open_file(const std::string& output) {
    if (output == standard_stream && isatty(STDOUT_FILENO) != 0)
        throw UsageError("-o -: stdout is a terminal, expected a pipe or a file");
    return open_named(output);
}

}  // namespace

PictureFile::PictureFile(const std::string& output, PictureFormat format)
    : format_(format), file_(open_file(output)) {}

std::size_t PictureFile::write(const Image& image, const glm::dvec3& background,
                               const PictureAttributes& attributes, ImageColorSpace space) {
    std::size_t clamped = 0;
    switch (format_) {
        case PictureFormat::exr:
            write_exr(*file_, image, attributes, space);
            break;
        case PictureFormat::png:
            clamped = write_png(*file_, image, background, space);
            break;
        case PictureFormat::npy:
            write_npy(*file_, image);
            break;
    }
    file_->commit();
    return clamped;
}

std::size_t PictureFile::write(const PreciseImage& image, const glm::dvec3& background,
                               const PictureAttributes& attributes, ImageColorSpace space) {
    if (format_ != PictureFormat::npy) return write(to_float(image), background, attributes, space);
    write_npy(*file_, image);
    file_->commit();
    return 0;
}

}  // namespace lamina
