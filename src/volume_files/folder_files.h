// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

namespace lamina {

// The regular files in a folder, but for hidden ones, in the order of the numbers in their names:
// a2 before a10. None where it cannot be read.
std::vector<std::filesystem::path> files_in_folder(const std::filesystem::path& folder);

}  // namespace lamina
