// SPDX-License-Identifier: Apache-2.0
#include "base/content_hash.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <vector>

#include "base/client.h"
#include "base/error.h"
#include "base/input_file.h"

namespace lamina {

std::string hash_of_file(const std::filesystem::path& path) {
    expect_regular_file(path);
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"),
                                                               &std::fclose);
    if (!file) fail("{}: cannot read: {}", path.string(), std::strerror(errno));
    ContentHash hash;
    std::vector<char> bytes(std::size_t{1} << 20);
    for (std::size_t count = bytes.size(); count == bytes.size();) {
        check_interrupt();
        count = std::fread(bytes.data(), 1, bytes.size(), file.get());
        hash.add(bytes.data(), count);
    }
    if (std::ferror(file.get()) != 0)
        fail("{}: cannot read: {}", path.string(), std::strerror(errno));
    return hash.hex();
}

}  // namespace lamina
