// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>

namespace lamina {

using OpenedFile = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

// Opens a regular file at byte `offset`. Throws Error.
OpenedFile open_to_read(const std::filesystem::path& path, std::int64_t offset = 0);

// The number of bytes from the current position of the file to its end.
std::uint64_t bytes_left(std::FILE* file);

}  // namespace lamina
