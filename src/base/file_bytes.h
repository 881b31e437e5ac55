// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace lamina {

// Throws Error unless `path` is a regular file, because opening a pipe may never end.
void expect_regular_file(const std::filesystem::path& path);

// Reads all bytes of a regular file. Throws Error where it is not one or cannot be read.
std::string read_file_bytes(const std::filesystem::path& path);

}  // namespace lamina
