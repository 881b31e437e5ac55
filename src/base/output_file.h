// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <string>
#include <utility>

#include "base/error.h"

namespace lamina {

// A file cannot be written: the disk is full, the folder is gone, and so on. Other files cannot be
// written then, either.
class WriteError : public Error {
  public:
    using Error::Error;
};

// What an output is written to: a stream that can seek. Nothing of it reaches its destination
// before commit(), and without commit() nothing does.
class OutputFile {
  public:
    virtual ~OutputFile() = default;
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    const std::filesystem::path& path() const { return path_; }  // for messages
    std::FILE* stream() { return stream_; }

    void write(const void* bytes, std::size_t count);  // throws WriteError
    void write(const std::string& text) { write(text.data(), text.size()); }
    virtual void commit() = 0;  // throws WriteError

  protected:
    explicit OutputFile(std::filesystem::path path) : path_(std::move(path)) {}
    [[noreturn]] void give_up(int error) const;

    std::filesystem::path path_;
    std::FILE* stream_ = nullptr;
};

}  // namespace lamina
