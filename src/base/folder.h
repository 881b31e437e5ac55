// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace lamina {

// Makes a folder and its parent folders, where they do not exist yet. Throws Error.
void make_folder(const std::filesystem::path& folder);

}  // namespace lamina
