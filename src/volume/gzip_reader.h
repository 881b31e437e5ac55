// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <zlib.h>

#include <cstddef>
#include <cstdio>
#include <string>
#include <vector>

namespace lamina {

// Decompresses a gzip stream (of one or more members) from where `stream` stands. (teem 1.12 does
// not notice a damaged or missing checksum.) Throws Error; `file` is for messages.
class GzipReader {
  public:
    GzipReader(std::FILE* stream, std::string file);
    ~GzipReader();
    GzipReader(const GzipReader&) = delete;
    GzipReader& operator=(const GzipReader&) = delete;

    void read(void* bytes, std::size_t count);
    void skip(std::size_t count);
    void check_end();  // once all is read: that the checksum of what was read is there and right

  private:
    bool inflate_some();  // false at the end of the compressed data

    std::FILE* stream_;
    std::string file_;
    std::vector<unsigned char> input_;
    z_stream state_{};
};

}  // namespace lamina
