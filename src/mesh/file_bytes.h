// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace lamina {

// All bytes of a regular file. Throws Error when it is none or cannot be read.
std::string read_file_bytes(const std::filesystem::path& path);

}  // namespace lamina
