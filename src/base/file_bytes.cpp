// SPDX-License-Identifier: Apache-2.0
#include "base/file_bytes.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <memory>
#include <system_error>

#include "base/error.h"
#include "base/interrupt.h"

namespace lamina {

void expect_regular_file(const std::filesystem::path& path) {
    std::error_code ignored;
    const auto status = std::filesystem::status(path, ignored);
    if (!std::filesystem::exists(status)) fail("{}: cannot read: no such file", path.string());
    if (!std::filesystem::is_regular_file(status)) {
        fail("{}: cannot read: not a regular file", path.string());
    }
}

std::string read_file_bytes(const std::filesystem::path& path) {
    expect_regular_file(path);
    std::error_code error;
    const auto size = std::filesystem::file_size(path, error);
    if (error) fail("{}: cannot read: {}", path.string(), error.message());
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"),
                                                               &std::fclose);
    if (!file) fail("{}: cannot read: {}", path.string(), std::strerror(errno));

    constexpr std::size_t step = std::size_t{1} << 26;  // bytes between checks for a requested stop
    std::string bytes(size, '\0');
    for (std::size_t done = 0; done < bytes.size();) {
        check_interrupt();
        const std::size_t wanted = std::min(bytes.size() - done, step);
        const std::size_t got = std::fread(bytes.data() + done, 1, wanted, file.get());
        done += got;
        if (got == wanted) continue;
        if (std::ferror(file.get()) != 0) {
            fail("{}: cannot read: {}", path.string(), std::strerror(errno));
        }
        bytes.resize(done);  // another process has shortened the file meanwhile
    }
    return bytes;
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
