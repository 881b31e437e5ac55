// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

namespace lamina {

// Checks the headers of an OpenEXR file before OpenEXR reads them. Throws Error where an attribute,
// or the table of tiles, promises more bytes than the file has left, or where the length of an
// attribute does not fit its type. OpenEXR 3.1 would take up to 2 GiB of memory for such an
// attribute, or read beyond it. OpenEXR reports other defects of a header itself.
void check_exr_header(const std::filesystem::path& path, std::uint64_t file_bytes);

}  // namespace lamina
