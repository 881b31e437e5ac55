// SPDX-License-Identifier: Apache-2.0
#include "base/file_bytes.h"

#include <fstream>
#include <system_error>

#include "base/error.h"
#include "base/random_access_file.h"

namespace lamina {

void expect_regular_file(const std::filesystem::path& path) {
    std::error_code ignored;
    const auto status = std::filesystem::status(path, ignored);
    if (!std::filesystem::exists(status)) fail("{}: cannot read: no such file", path.string());
    if (!std::filesystem::is_regular_file(status)) {
        fail("{}: cannot read: not a regular file", path.string());
    }
}

ByteBuffer read_large_file(const std::filesystem::path& path) {
    const RandomAccessFile file(path);
    ByteBuffer bytes(file.size());
    bytes.shorten(file.read_some(0, bytes.data(), bytes.size()));
    return bytes;
}

std::string read_file_bytes(const std::filesystem::path& path) {
    return std::string(read_large_file(path).text());
}

std::string file_beginning(const std::filesystem::path& path, std::size_t most) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored)) return {};
    std::ifstream stream(path, std::ios::binary);
    std::string bytes(most, '\0');
    stream.read(bytes.data(), static_cast<std::streamsize>(most));
    bytes.resize(static_cast<std::size_t>(stream.gcount()));
    return bytes;
}

}  // namespace lamina
