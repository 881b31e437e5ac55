// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace lamina {

// A file as it was when it was opened.
struct FileState {
    // Throws Error where there is no such file.
    static FileState of(const std::filesystem::path& path);

    // Throws Error where the file has another size or time now.
    void check_unchanged() const;
    std::string text() const;        // tells it from others, and from what it may become
    std::string bytes_hash() const;  // of some of its bytes, as they are now; throws Error

    std::filesystem::path path;
    std::uint64_t bytes = 0;
    std::int64_t modified = 0;  // nanoseconds
    // These tell a file from a copy with its size and time. A file that is moved, or gets another
    // mode, has another `changed`: check_unchanged() passes, text() differs.
    std::uint64_t inode = 0;
    std::int64_t changed = 0;  // nanoseconds
};

}  // namespace lamina
