// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

#include "volume_files/byte_reader.h"

namespace lamina {

// Data that lie in several files, the same number of bytes in each; the files are opened one after
// another.
class FileSequence : public ByteReader {
  public:
    using Paths = std::vector<std::filesystem::path>;
    using Opener = std::function<std::unique_ptr<ByteReader>(const std::filesystem::path&)>;

    FileSequence(Paths paths, std::size_t bytes_each, Opener open)
        : paths_(std::move(paths)), bytes_each_(bytes_each), open_(std::move(open)) {}

    void read(void* bytes, std::size_t count) override;
    void skip(std::size_t count) override;
    std::vector<std::string> surplus() override;

  private:
    // Calls step(reader, bytes) until `count` bytes are used, each time for bytes of one file.
    template <typename Step>
    void use(std::size_t count, const Step& step);

    Paths paths_;
    std::size_t bytes_each_;
    Opener open_;
    std::size_t next_ = 0;  // of paths_, to be opened
    std::unique_ptr<ByteReader> reader_;
    std::size_t left_ = 0;  // of bytes_each_ in the reader
    std::vector<std::string> surplus_;
};

}  // namespace lamina
