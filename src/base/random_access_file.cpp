// SPDX-License-Identifier: Apache-2.0
#include "base/random_access_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "base/error.h"
#include "base/file_bytes.h"
#include "base/interrupt.h"

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

}  // namespace lamina
