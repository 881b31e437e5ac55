// SPDX-License-Identifier: Apache-2.0
#include "volume/volume_file.h"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <string>

#include "base/error.h"
#include "base/file_bytes.h"
#include "volume/nrrd.h"
#include "volume/nrrd_header.h"

namespace lamina {
namespace {

using Path = std::filesystem::path;

std::vector<Path> files_of_nrrd(const Path& path) {
    return {path, read_nrrd_header(path).data_path};
}

struct VolumeFormat {
    const char* extension;  // in small letters
    Volume (*read)(const Path&);
    std::vector<Path> (*files)(const Path&);
};

constexpr VolumeFormat formats[] = {{".nrrd", read_nrrd, files_of_nrrd},
                                    {".nhdr", read_nrrd, files_of_nrrd}};

const VolumeFormat* find_format(const Path& path) {
    std::string extension = path.extension().string();
    std::ranges::transform(extension, extension.begin(), [](unsigned char letter) {
        return static_cast<char>(std::tolower(letter));
    });
    const auto* const found = std::ranges::find(formats, extension, &VolumeFormat::extension);
    return found == std::end(formats) ? nullptr : found;
}

// A NRRD file may have any name. Its reader looks for the magic number, and reports where it is
// missing.
const VolumeFormat& format_of(const Path& path) {
    const VolumeFormat* const found = find_format(path);
    return found ? *found : formats[0];
}

}  // namespace

bool is_volume_file(const Path& path) {
    return file_beginning(path, 5).starts_with("NRRD0") || find_format(path) != nullptr;
}

Volume read_volume(const Path& path) {
    return format_of(path).read(path);
}

std::vector<Path> files_of_volume(const Path& path) {
    try {
        return format_of(path).files(path);
    } catch (const Error&) {
        return {path};  // errors are reported when the volume is read
    }
}

}  // namespace lamina
