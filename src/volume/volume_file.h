// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "lamina/volume.h"

namespace lamina {

// By its content, or by the extension, in capitals or not: .nrrd or .nhdr.
bool is_volume_file(const std::filesystem::path& path);

// Reads a volume: a NRRD file (volume/nrrd.h), whatever its extension. Throws Error: one line that
// names the file, what was found and what was expected.
Volume read_volume(const std::filesystem::path& path);

// The file and those that reading it means, too. Where it cannot be read, it alone.
std::vector<std::filesystem::path> files_of_volume(const std::filesystem::path& path);

}  // namespace lamina
