// SPDX-License-Identifier: Apache-2.0
#include "base/input_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>
#include <vector>

#include "base/client.h"
#include "base/content_hash.h"
#include "base/error.h"

namespace lamina {

RandomAccessFile::RandomAccessFile(const std::filesystem::path& path) : name_(path.string()) {
    expect_regular_file(path);
    file_ = open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (file_ < 0) fail("{}: cannot read: {}", name_, std::strerror(errno));
    size_ = static_cast<std::uint64_t>(lseek(file_, 0, SEEK_END));
}

RandomAccessFile::~RandomAccessFile() {
    close(file_);
}

std::size_t RandomAccessFile::read_some(std::uint64_t begin, char* to, std::size_t count) const {
    constexpr std::size_t step = std::size_t{1} << 26;  // bytes between checks for a requested stop
    std::size_t done = 0;
    while (done < count) {
        check_interrupt();
        const ssize_t got =
            pread(file_, to + done, std::min(count - done, step), static_cast<off_t>(begin + done));
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) fail("{}: cannot read: {}", name_, std::strerror(errno));
        if (got == 0) break;
        done += static_cast<std::size_t>(got);
    }
    return done;
}

void RandomAccessFile::read(std::uint64_t begin, char* to, std::size_t count) const {
    const std::size_t got = read_some(begin, to, count);
    if (got < count)
        fail("{}: truncated: found {} bytes at byte {}, expected {}", name_, got, begin, count);
}

void RandomAccessFile::expect_in_order() const {
    posix_fadvise(file_, 0, 0, POSIX_FADV_SEQUENTIAL);
}

void RandomAccessFile::expect_single_reads() const {
    posix_fadvise(file_, 0, 0, POSIX_FADV_RANDOM);
}

bool is_restricted() {
    return ClientScope::current().only_below != nullptr;
}

void expect_allowed(const std::filesystem::path& path) {
    if (!is_restricted()) return;
    const std::filesystem::path& folder = *ClientScope::current().only_below;
    std::error_code unreadable;
    const auto real =
        std::filesystem::weakly_canonical(std::filesystem::absolute(path), unreadable);
    const auto parts = std::ranges::mismatch(folder, real);
    if (unreadable || parts.in1 != folder.end())
        fail("{}: not opened: it is not below {}", path.string(), folder.string());
}

const char* why_not_regular(const std::filesystem::path& path) {
    std::error_code ignored;
    const auto status = std::filesystem::status(path, ignored);
    if (std::filesystem::is_regular_file(status)) return nullptr;
    return std::filesystem::exists(status) ? "not a regular file" : "no such file";
}

void expect_regular_file(const std::filesystem::path& path) {
    expect_allowed(path);
    if (const char* const reason = why_not_regular(path))
        fail("{}: cannot read: {}", path.string(), reason);
}

ByteBuffer read_large_file(const std::filesystem::path& path) {
    const RandomAccessFile file(path);
    ByteBuffer bytes(file.size());
    bytes.shorten(file.read_some(0, bytes.data(), bytes.size()));
    return bytes;
}

std::string read_file_bytes(const std::filesystem::path& path) {
    // In bytes: far more than any text that lamina reads has.
    constexpr std::uint64_t most = std::uint64_t{1} << 30;
    const RandomAccessFile file(path);
    if (file.size() > most)
        fail("{}: found {} bytes, expected at most {}", path.string(), file.size(), most);
    std::string bytes(file.size(), '\0');
    bytes.resize(file.read_some(0, bytes.data(), bytes.size()));
    return bytes;
}

std::string hash_of_file(const std::filesystem::path& path) {
    const RandomAccessFile file(path);
    ContentHash hash;
    std::vector<char> bytes(std::size_t{1} << 20);
    std::uint64_t begin = 0;
    for (std::size_t count = bytes.size(); count == bytes.size(); begin += count) {
        count = file.read_some(begin, bytes.data(), bytes.size());
        hash.add(bytes.data(), count);
    }
    return hash.hex();
}

std::string file_beginning(const std::filesystem::path& path, std::size_t most) {
    std::error_code ignored;
    expect_allowed(path);
    if (!std::filesystem::is_regular_file(path, ignored)) return {};
    std::ifstream stream(path, std::ios::binary);
    std::string bytes(most, '\0');
    stream.read(bytes.data(), static_cast<std::streamsize>(most));
    bytes.resize(static_cast<std::size_t>(stream.gcount()));
    return bytes;
}

}  // namespace lamina
