// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace lamina {

// Memory for bytes that will be filled right after it is made; it is not zeroed.
class ByteBuffer {
  public:
    ByteBuffer() = default;
    explicit ByteBuffer(std::size_t size)  // throws std::bad_alloc
        : bytes_(std::make_unique_for_overwrite<char[]>(size)), size_(size) {}

    char* data() { return bytes_.get(); }
    std::size_t size() const { return size_; }
    std::string_view text() const { return {bytes_.get(), size_}; }
    std::span<char> span() { return {bytes_.get(), size_}; }
    void shorten(std::size_t size) { size_ = size; }

  private:
    std::unique_ptr<char[]> bytes_;
    std::size_t size_ = 0;
};

// A regular file, read at any position. Throws Error if it is not one or cannot be read.
class RandomAccessFile {
  public:
    explicit RandomAccessFile(const std::filesystem::path& path);
    RandomAccessFile(const RandomAccessFile&) = delete;
    RandomAccessFile& operator=(const RandomAccessFile&) = delete;
    ~RandomAccessFile();

    std::uint64_t size() const { return size_; }  // in bytes, when it was opened
    // Reads `count` bytes from `begin` on, fewer at the end of the file; returns their number.
    std::size_t read_some(std::uint64_t begin, char* to, std::size_t count) const;
    // Reads all `count` bytes, or throws Error.
    void read(std::uint64_t begin, char* to, std::size_t count) const;
    // Tells the system that reads go forwards, so that it reads further ahead.
    void expect_in_order() const;
    // Tells the system that reads are scattered, so that it does not read ahead.
    void expect_single_reads() const;

  private:
    std::string name_;
    int file_;
    std::uint64_t size_;
};

// Throws Error if this thread's client allows only files below a folder (base/client.h) and `path`,
// with all links followed, is neither this folder nor below it.
void expect_allowed(const std::filesystem::path& path);

// Tells whether this thread's client allows only files below a folder.
bool is_restricted();

// Returns "no such file" or "not a regular file", or nullptr if `path` is a regular file.
const char* why_not_regular(const std::filesystem::path& path);

// Throws Error unless `path` is allowed and is a regular file: opening a pipe may never end.
void expect_regular_file(const std::filesystem::path& path);

// Reads all bytes of a regular file. Throws Error if it is not one or cannot be read.
ByteBuffer read_large_file(const std::filesystem::path& path);
std::string read_file_bytes(const std::filesystem::path& path);  // of at most 1 GiB

// Returns at most the first `most` bytes of a file; "" if it is no readable, regular file.
std::string file_beginning(const std::filesystem::path& path, std::size_t most);

// Returns a regular file's ContentHash (base/content_hash.h). Throws Error if it is unreadable.
std::string hash_of_file(const std::filesystem::path& path);

// A file of the source tree that the build embeds into the program (cmake/EmbedFiles.cmake).
struct EmbeddedFile {
    std::string_view name;  // relative to the embedded folder: "slicing/slab.frag"
    std::string_view text;
};

}  // namespace lamina
