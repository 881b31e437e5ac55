// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace lamina {

// A hash of a file's bytes (base/content_hash.h), read a piece at a time. Throws Error where it is
// no regular file or cannot be read.
std::string hash_of_file(const std::filesystem::path& path);

}  // namespace lamina
