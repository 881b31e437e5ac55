// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "lamina/volume.h"
#include "volume_files/volume_opening.h"

namespace lamina {

// Tells if a file or folder is a volume: by its content or, if that does not tell, by its extension
// (upper or lower case).
bool is_volume_file(const std::filesystem::path& path);
// Returns the name of the format that is_volume_file() finds; empty if it finds none.
std::string_view volume_format_of(const std::filesystem::path& path);

// Reads a volume of any format into memory. Throws Error: one line that names the file, what was
// found and what was expected. Warnings (base/client.h) say which of several arrays, channels or
// times was read, which values were rounded, and what was not used.
Volume read_volume(const std::filesystem::path& path, const VolumeRequest& request = {});
// Opens a volume, which may stay in its files, as `use` says.
Volume open_volume(const std::filesystem::path& path, const VolumeRequest& request,
                   const VolumeUse& use);

// Returns the file and the files that it refers to; the file alone if it cannot be read.
std::vector<std::filesystem::path> files_of_volume(const std::filesystem::path& path,
                                                   const VolumeRequest& request = {});

// Returns the formats by name, with their extensions, for people: "NRRD (.nrrd, .nhdr), ...".
std::string volume_format_names();

}  // namespace lamina
