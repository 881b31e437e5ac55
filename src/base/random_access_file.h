// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

namespace lamina {

// A regular file of which any part can be read. Throws Error where it is none or cannot be read.
class RandomAccessFile {
  public:
    explicit RandomAccessFile(const std::filesystem::path& path);
    RandomAccessFile(const RandomAccessFile&) = delete;
    RandomAccessFile& operator=(const RandomAccessFile&) = delete;
    ~RandomAccessFile();

    std::uint64_t size() const { return size_; }  // in bytes, when it was opened
    // Returns how many of the bytes from `begin` on there are; fewer than `count` at the file's
    // end.
    std::size_t read_some(std::uint64_t begin, char* to, std::size_t count) const;
    void read(std::uint64_t begin, char* to, std::size_t count) const;  // all of them
    // For who reads from first to last alone: the system then reads further ahead.
    void expect_in_order() const;
    // For reads of single places: the system then reads nothing but what is asked for.
    void expect_single_reads() const;

  private:
    std::string name_;
    int file_;
    std::uint64_t size_;
};

}  // namespace lamina
