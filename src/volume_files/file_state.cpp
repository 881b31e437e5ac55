// SPDX-License-Identifier: Apache-2.0
#include "volume_files/file_state.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstring>

#include "base/error.h"
#include "base/input_file.h"
#include "volume_files/some_bytes.h"

namespace lamina {

FileState FileState::of(const std::filesystem::path& path) {
    expect_allowed(path);
    struct stat found {};
    if (stat(path.c_str(), &found) != 0)
        fail("{}: cannot read: {}", path.string(), std::strerror(errno));
    const auto nanoseconds = [](const timespec& time) {
        return time.tv_sec * std::int64_t{1'000'000'000} + time.tv_nsec;
    };
    return {path, static_cast<std::uint64_t>(found.st_size), nanoseconds(found.st_mtim),
            static_cast<std::uint64_t>(found.st_ino), nanoseconds(found.st_ctim)};
}

void FileState::check_unchanged() const {
    const FileState now = of(path);
    if (now.bytes != bytes)
        fail("{}: found {} bytes, expected {}: the file was changed while it was read",
             path.string(), now.bytes, bytes);
    if (now.modified != modified) fail("{}: the file was changed while it was read", path.string());
}

std::string FileState::text() const {
    return fmt::format("{} {} {} {} {}", std::filesystem::absolute(path).string(), bytes, modified,
                       inode, changed);
}

std::string FileState::bytes_hash() const {
    const RandomAccessFile file(path);
    ContentHash hash;
    add_some_bytes(hash, file.size(), [&](std::uint64_t place, char* to, std::size_t count) {
        file.read(place, to, count);
    });
    return hash.hex();
}

}  // namespace lamina
