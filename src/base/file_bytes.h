// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace lamina {

// Throws Error unless it is a regular file: opening a pipe may never end.
void expect_regular_file(const std::filesystem::path& path);

// All bytes of a regular file. Throws Error when it is none or cannot be read.
std::string read_file_bytes(const std::filesystem::path& path);

}  // namespace lamina
