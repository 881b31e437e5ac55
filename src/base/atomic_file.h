// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <filesystem>
#include <string>

namespace lamina {

// An output file that appears under its name only when it is complete: written beside it, then
// renamed. Made before long work begins, so that a path that cannot be written fails at once;
// without commit() nothing is left behind.
class AtomicFile {
  public:
    explicit AtomicFile(
        std::filesystem::path path);  // throws Error when the folder cannot be written
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    const std::filesystem::path& path() const { return path_; }
    const std::filesystem::path& temporary_path() const { return temporary_; }
    std::FILE* stream() { return stream_; }

    void write(const void* bytes, std::size_t count);  // throws Error (disk full, ...)
    void write(const std::string& text) { write(text.data(), text.size()); }
    void close_stream();  // for writers that want to write temporary_path() by themselves
    void commit();        // throws Error

  private:
    std::filesystem::path path_;
    std::filesystem::path temporary_;
    std::FILE* stream_ = nullptr;
    bool committed_ = false;
};

}  // namespace lamina
