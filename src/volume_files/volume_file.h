// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lamina/volume.h"
#include "lamina/volume_request.h"
#include "volume_files/volume_opening.h"

namespace lamina {

// By its content, or by its extension, in capitals or not (volume_files/volume_format.h).
bool is_volume_file(const std::filesystem::path& path);

// Reads a volume of any format. Throws Error: one line that names the file, what was found and what
// was expected. What was taken of several, rounded or left over is said in warnings
// (base/client.h).
Volume read_volume(const std::filesystem::path& path, const VolumeRequest& request = {});
// The same for a volume that may stay in its files.
Volume open_volume(const std::filesystem::path& path, const VolumeRequest& request,
                   const VolumeUse& use);

// The file and those that reading it means, too. Where it cannot be read, it alone.
std::vector<std::filesystem::path> files_of_volume(const std::filesystem::path& path,
                                                   const VolumeRequest& request = {});

// The formats by name, with their extensions, for people: "NRRD (.nrrd, .nhdr), ...".
std::string volume_format_names();

}  // namespace lamina
