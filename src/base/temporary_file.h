// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdio>
#include <string>

namespace lamina {

// The folder of temporary files: TMPDIR, or /tmp where it is not set.
std::string temporary_folder();

// A temporary file without a name. It disappears with this object, and with the process, however
// that ends.
class TemporaryFile {
  public:
    TemporaryFile();  // throws Error
    ~TemporaryFile() { std::fclose(stream_); }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    std::FILE* stream() const { return stream_; }
    void write(const void* bytes, std::size_t count);  // throws Error
    // Writes out what is buffered and goes to the first byte, for any reader. Throws Error.
    void rewind();

  private:
    std::FILE* stream_ = nullptr;
};

}  // namespace lamina
