// SPDX-License-Identifier: Apache-2.0
#include "volume_files/file_state.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstring>

#include "base/content_hash.h"
#include "base/error.h"
#include "base/random_access_file.h"

namespace lamina {

FileState FileState::of(const std::filesystem::path& path) {
    struct stat found {};
    if (stat(path.c_str(), &found) != 0)
        fail("{}: cannot read: {}", path.string(), std::strerror(errno));
    constexpr std::int64_t per_second = 1'000'000'000;
    return {path, static_cast<std::uint64_t>(found.st_size),
            found.st_mtim.tv_sec * per_second + found.st_mtim.tv_nsec};
}

void FileState::check_unchanged() const {
    const FileState now = of(path);
    if (now.bytes != bytes)
        fail("{}: found {} bytes, expected {}: the file was changed while it was read",
             path.string(), now.bytes, bytes);
    if (now.modified != modified) fail("{}: the file was changed while it was read", path.string());
}

std::string FileState::text() const {
    return fmt::format("{} {} {}", std::filesystem::absolute(path).string(), bytes, modified);
}

std::string FileState::bytes_hash() const {
    constexpr std::uint64_t places = 64, most_bytes = 4096;
    const RandomAccessFile file(path);
    ContentHash hash;
    char some[most_bytes];
    for (std::uint64_t i = 0; i < places; ++i)
        hash.add(some, file.read_some(file.size() / places * i, some, most_bytes));
    return hash.hex();
}

}  // namespace lamina
