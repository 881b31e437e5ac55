// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace lamina {

using OpenedFile = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

// Opens a regular file at byte `offset`. Throws Error.
OpenedFile open_to_read(const std::filesystem::path& path, std::int64_t offset = 0);

// Returns the number of bytes from the current position of the file to its end.
std::uint64_t bytes_left(std::FILE* file);

// Returns the number that up to 8 bytes hold, the lowest first or, if `big_endian`, the highest.
inline std::uint64_t number_of_bytes(std::string_view bytes, bool big_endian) {
    std::uint64_t number = 0;
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        const char byte = bytes[big_endian ? i : bytes.size() - 1 - i];
        number = number << 8 | static_cast<unsigned char>(byte);
    }
    return number;
}

// Reads the data of a file, decompressed, in order. All functions throw Error if the data have too
// few bytes or are damaged. Long work ends when its client requests a stop (base/client.h).
class ByteReader {
  public:
    ByteReader() = default;
    virtual ~ByteReader() = default;
    ByteReader(const ByteReader&) = delete;
    ByteReader& operator=(const ByteReader&) = delete;

    virtual void read(void* bytes, std::size_t count) = 0;
    virtual void skip(std::size_t count) = 0;
    // Must be called when all data are read. Verifies checksums behind them. Returns descriptions
    // of surplus bytes, which a message continues with "than ...", such as "12 bytes more"; or
    // none.
    virtual std::vector<std::string> surplus() = 0;
};

// Readers of an open file from its current position on. `name`: the file's, for messages.

// Reads uncompressed bytes. `counts_surplus`: surplus() reports bytes behind the data.
std::unique_ptr<ByteReader> file_reader(OpenedFile file, std::string name, bool counts_surplus);

// Decompresses gzip or zlib streams, one or more members, and verifies checksums. (teem 1.12 does
// not notice a damaged or missing checksum.)
std::unique_ptr<ByteReader> gzip_reader(OpenedFile file, std::string name);
// Decompresses bzip2 streams likewise. (teem 1.12 does not notice that the end is missing.)
std::unique_ptr<ByteReader> bzip2_reader(OpenedFile file, std::string name);

// Reads pairs of hexadecimal digits, with blanks between them that do not count.
std::unique_ptr<ByteReader> hex_reader(OpenedFile file, std::string name);

// Most bytes that one compressed byte decompresses to. Deflate codes at most 258 bytes in 2 bits
// (zlib, "Technical details"); bzip2 codes a block of 900,000 bytes, in which each 5 stand for a
// run of 259, in no less than 40 bytes.
inline constexpr std::uint64_t gzip_expansion = 1032;
inline constexpr std::uint64_t bzip2_expansion = 900000 / 5 * 259 / 40;

// Surplus bytes of compressed data are counted up to 64 MiB: a small file may hold very many.
inline constexpr std::uint64_t most_counted_surplus = std::uint64_t{1} << 26;

// Reads `bytes_each` bytes of each file; `open` makes the reader of a file when it is needed.
std::unique_ptr<ByteReader> sequence_reader(
    std::vector<std::filesystem::path> paths, std::size_t bytes_each,
    std::function<std::unique_ptr<ByteReader>(const std::filesystem::path&)> open);

}  // namespace lamina
