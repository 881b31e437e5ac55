// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <filesystem>
#include <string>

#include "base/error.h"

namespace lamina {

// A file cannot be written: the disk is full, the folder is gone, and so on. Other files cannot be
// written then, either.
class WriteError : public Error {
  public:
    using Error::Error;
};

// An output file that appears under its name only when it is complete. It is opened before long
// work begins, so that a path that cannot be written fails at once. Without commit() nothing is
// left behind, not even when the process is killed, because until then the file has no name where
// the file system allows that. Where it does not (NFS), and during commit(), the file lies beside
// its destination as NAME.lamina-N.part and is locked. If a killed process leaves such a file
// there, the next one of this name removes it.
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
    // Writes all of the file to disk under a temporary name beside its destination. This is for
    // files that belong together, whose commit() is then only a renaming. Throws WriteError.
    void complete();
    void commit();  // throws WriteError

  private:
    void close_stream();
    bool open_nameless();  // false where the file system does not allow it
    void open_named();
    void open_stream();
    void give_name();
    [[noreturn]] void give_up(int error) const;

    std::filesystem::path path_;
    std::filesystem::path temporary_;  // temporary name; empty where there is none
    int descriptor_ = -1;              // open until the end, for its lock and to give it a name
    std::FILE* stream_ = nullptr;
};

}  // namespace lamina
