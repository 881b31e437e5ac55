// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "lamina/volume.h"
#include "lamina/volume_request.h"
#include "volume_files/volume_opening.h"

namespace lamina {

// A kind of files that hold volumes.
struct VolumeFormat {
    const char* name;  // "NIfTI"
    // In small letters, for files whose content tells nothing because they are damaged; an empty
    // one ends the list.
    const char* extensions[4];
    // By the content of a file, or of the files in a folder. Never throws.
    bool (*recognizes)(const std::filesystem::path& path);
    // Both throw Error: one line that names the file, what was found and what was expected.
    Volume (*read)(const std::filesystem::path& path, const VolumeRequest& request);
    std::vector<std::filesystem::path> (*files)(const std::filesystem::path& path);
    // Whether such files may hold several of these; read() then heeds the request's key.
    bool has_arrays, has_levels, has_channels, has_times;
    // The same as `read` for volumes that may stay in their files; null where such files are always
    // read as a whole.
    Volume (*open)(const std::filesystem::path& path, const VolumeRequest& request,
                   const VolumeUse& use) = nullptr;
};

std::span<const VolumeFormat> volume_formats();

// The format of a file or folder: by its content, else by its extension, in capitals or not. Null
// where neither tells.
const VolumeFormat* format_of(const std::filesystem::path& path);

}  // namespace lamina
