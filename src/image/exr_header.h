// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

namespace lamina {

// Walks the headers of an OpenEXR file and throws Error where an attribute, or the table of tiles,
// promises more bytes than the file has left, or where an attribute is not as long as its type is:
// OpenEXR 3.1 takes memory for up to 2 GiB on an attribute's word, and reads past attributes by
// their types. What else may be wrong with a header OpenEXR says itself.
void check_exr_header(const std::filesystem::path& path, std::uint64_t file_bytes);

}  // namespace lamina
