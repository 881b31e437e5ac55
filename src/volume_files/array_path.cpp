// SPDX-License-Identifier: Apache-2.0
// Names of arrays in files, and HDF5's signature: also in builds without HDF5, which name the
// format of such files.
#include "volume_files/array_path.h"

#include <string_view>

#include "base/input_file.h"
#include "volume_files/volume_formats.h"

namespace lamina {

ArrayPath array_path(const std::filesystem::path& path) {
    std::error_code unreadable;
    if (std::filesystem::exists(path, unreadable)) return {path, ""};
    const std::string text = path.string();
    for (std::size_t at = text.find(":/"); at != std::string::npos; at = text.find(":/", at + 1)) {
        const std::filesystem::path file = text.substr(0, at);
        if (std::filesystem::is_regular_file(file, unreadable)) return {file, text.substr(at + 1)};
    }
    return {path, ""};
}

bool is_hdf5(const std::filesystem::path& path) {
    constexpr std::string_view signature("\x89HDF\r\n\x1a\n", 8);
    const std::filesystem::path file = array_path(path).file;
    std::error_code unreadable;
    if (std::filesystem::is_directory(file, unreadable)) return false;
    const std::string beginning = file_beginning(file, 2048 + signature.size());
    for (const std::size_t at : {0, 512, 1024, 2048}) {
        if (beginning.size() > at && std::string_view(beginning).substr(at).starts_with(signature))
            return true;
    }
    return false;
}

}  // namespace lamina
