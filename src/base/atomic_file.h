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
// can do that. Where it cannot (NFS), and in the moment of commit(), it lies beside its place as
// NAME.lamina-N.part, locked: what a killed process left there the next one of this name removes.
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
    // All of it is written, under a name of its own beside its place: for files that belong
    // together, whose commit() is a mere renaming then. Throws WriteError.
    void complete();
    void commit();  // throws WriteError

  private:
    void close_stream();
    bool open_nameless();  // false: this cannot be done here
    void open_named();
    void open_stream();
    void give_name();
    [[noreturn]] void give_up(int error) const;

    std::filesystem::path path_;
    std::filesystem::path temporary_;  // its name for now; empty: none
    int descriptor_ = -1;              // to the end, for its lock and to give it a name
    std::FILE* stream_ = nullptr;
};

}  // namespace lamina
