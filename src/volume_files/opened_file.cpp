// SPDX-License-Identifier: Apache-2.0
#include "volume_files/opened_file.h"

#include <cerrno>
#include <cstring>

#include "base/error.h"
#include "base/input_file.h"

namespace lamina {

OpenedFile open_to_read(const std::filesystem::path& path, std::int64_t offset) {
    expect_regular_file(path);
    OpenedFile file(std::fopen(path.c_str(), "rb"), &std::fclose);
    if (!file || fseeko(file.get(), offset, SEEK_SET) != 0)
        fail("{}: cannot read: {}", path.string(), std::strerror(errno));
    return file;
}

std::uint64_t bytes_left(std::FILE* file) {
    const off_t here = ftello(file);
    fseeko(file, 0, SEEK_END);
    const off_t end = ftello(file);
    fseeko(file, here, SEEK_SET);
    return end > here ? static_cast<std::uint64_t>(end - here) : 0;
}

}  // namespace lamina
