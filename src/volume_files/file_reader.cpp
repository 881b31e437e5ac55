// SPDX-License-Identifier: Apache-2.0
#include "volume_files/file_reader.h"

#include <algorithm>

#include "base/client.h"
#include "base/error.h"

namespace lamina {

void FileReader::read(void* bytes, std::size_t count) {
    constexpr std::size_t step = std::size_t{1} << 26;  // bytes between checks for a requested stop
    for (std::size_t done = 0; done < count;) {
        check_interrupt();
        const std::size_t wanted = std::min(count - done, step);
        const std::size_t got =
            std::fread(static_cast<char*>(bytes) + done, 1, wanted, file_.get());
        done += got;
        if (got != wanted) fail("{}: found {} bytes of data, expected {}", name_, done, count);
    }
}

void FileReader::skip(std::size_t count) {
    const std::uint64_t left = bytes_left(file_.get());
    if (count > left) fail("{}: found {} bytes of data, expected {}", name_, left, count);
    fseeko(file_.get(), static_cast<off_t>(count), SEEK_CUR);
}

std::vector<std::string> FileReader::surplus() {
    const std::uint64_t left = counts_surplus_ ? bytes_left(file_.get()) : 0;
    if (left == 0) return {};
    return {fmt::format("{} bytes more", left)};
}

}  // namespace lamina
