// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace lamina {

using OpenedFile = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

// Opens a regular file at byte `offset`. Throws Error.
OpenedFile open_to_read(const std::filesystem::path& path, std::int64_t offset = 0);

// Returns the number of bytes from the current position of the file to its end.
std::uint64_t bytes_left(std::FILE* file);

// Reads the bytes of a file's data from first to last, in whatever way they are stored. All
// functions throw Error, which names the file, if there are fewer bytes than asked for or if they
// are damaged. Long work ends when its client requests a stop.
class ByteReader {
  public:
    ByteReader() = default;
    virtual ~ByteReader() = default;
    ByteReader(const ByteReader&) = delete;
    ByteReader& operator=(const ByteReader&) = delete;

    virtual void read(void* bytes, std::size_t count) = 0;
    virtual void skip(std::size_t count) = 0;
    // Must be called once all is read. Verifies what follows, such as checksums, and returns what
    // the file has beyond the data, in words that go before "than the header promises": mostly
    // nothing.
    virtual std::vector<std::string> surplus() = 0;
};

// The readers below take the bytes of an open file from its current position on. `name`: for
// messages.

// Reads bytes as they are. `counts_surplus`: bytes behind what is read are unexpected.
std::unique_ptr<ByteReader> file_reader(OpenedFile file, std::string name, bool counts_surplus);

// Decompresses gzip or zlib streams, one or more members, and verifies checksums. (teem 1.12 does
// not notice a damaged or missing checksum.)
std::unique_ptr<ByteReader> gzip_reader(OpenedFile file, std::string name);
// Decompresses bzip2 streams likewise. (teem 1.12 does not notice that the end is missing.)
std::unique_ptr<ByteReader> bzip2_reader(OpenedFile file, std::string name);

// Most bytes that one compressed byte gives. Deflate codes at most 258 bytes in 2 bits (zlib,
// "Technical details"); bzip2 codes a block of 900,000 bytes, in which each 5 stand for a run of
// 259, in no less than 40 bytes.
inline constexpr std::uint64_t gzip_expansion = 1032;
inline constexpr std::uint64_t bzip2_expansion = 900000 / 5 * 259 / 40;

// Bytes up to which decompressed data beyond what was read are counted.
inline constexpr std::uint64_t most_counted_surplus = std::uint64_t{1} << 26;

// Reads data that lie in several files, `bytes_each` bytes in each. `open` opens them one after
// another.
std::unique_ptr<ByteReader> sequence_reader(
    std::vector<std::filesystem::path> paths, std::size_t bytes_each,
    std::function<std::unique_ptr<ByteReader>(const std::filesystem::path&)> open);

}  // namespace lamina
