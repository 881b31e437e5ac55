// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <filesystem>
#include <string>

#include "base/error.h"

namespace lamina {

// The disk is full, the folder gone, ...: what is made next cannot be written, either.
class WriteError : public Error {
  public:
    using Error::Error;
};

// An output file that appears under its name only when it is complete. Made before long work
// begins, so that a path that cannot be written fails at once; without commit() nothing is left
// behind, nor when the process is killed: the file has no name until then, where the file system
// can do that (Linux's own can; on others it lies beside its place as NAME.PID.N.part).
class AtomicFile {
  public:
    explicit AtomicFile(
        std::filesystem::path path);  // throws WriteError when the folder cannot be written
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    const std::filesystem::path& path() const { return path_; }
    std::FILE* stream() { return stream_; }

    void write(const void* bytes, std::size_t count);  // throws WriteError
    void write(const std::string& text) { write(text.data(), text.size()); }
    // All of it is on the disk, under a name of its own beside its place: for files that belong
    // together, whose commit() is a mere renaming then. Throws WriteError.
    void complete();
    void commit();  // throws WriteError

  private:
    void close_stream();
    void open_nameless();
    void open_named();
    void give_name();
    [[noreturn]] void give_up(int error) const;

    std::filesystem::path path_;
    std::filesystem::path temporary_;  // its name for now; empty: none
    int nameless_ = -1;                // its descriptor while it has no name
    std::FILE* stream_ = nullptr;
};

}  // namespace lamina
