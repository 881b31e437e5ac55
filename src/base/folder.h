// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace lamina {

// With the folders that it is in, where they are not there yet. Throws Error.
void make_folder(const std::filesystem::path& folder);

}  // namespace lamina
