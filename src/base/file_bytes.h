// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "base/byte_buffer.h"

namespace lamina {

// Throws Error if this thread's client allows files below a folder only (base/client.h), and
// `path`, with all links followed, is neither that folder nor below it.
void expect_allowed(const std::filesystem::path& path);

// Tells whether this thread's client allows some files only.
bool is_restricted();

// Throws Error unless `path` is a regular file, because opening a pipe may never end, and allowed.
void expect_regular_file(const std::filesystem::path& path);

// Reads all bytes of a regular file. Throws Error where it is not one or cannot be read.
ByteBuffer read_large_file(const std::filesystem::path& path);
std::string read_file_bytes(const std::filesystem::path& path);  // of a small one

// Up to so many bytes of the file's beginning; none where it is not a regular file or cannot be
// read.
std::string file_beginning(const std::filesystem::path& path, std::size_t most);

}  // namespace lamina
