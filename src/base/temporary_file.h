// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdio>
#include <string>

namespace lamina {

// Where temporary files lie: TMPDIR, else /tmp.
std::string temporary_folder();

// A file there without a name: gone with this object, and with the process, however that ends.
class TemporaryFile {
  public:
    TemporaryFile();  // throws Error
    ~TemporaryFile() { std::fclose(stream_); }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    std::FILE* stream() const { return stream_; }
    void write(const void* bytes, std::size_t count);  // throws Error
    // Writes out what is buffered; the next byte, of whoever reads, is the first. Throws Error.
    void rewind();

  private:
    std::FILE* stream_ = nullptr;
};

}  // namespace lamina
