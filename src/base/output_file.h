// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"

namespace lamina {

// A file cannot be written (disk full, folder gone); other files then probably fail, too.
class WriteError : public Error {
  public:
    using Error::Error;
};

// A seekable stream that takes a result. Nothing appears at the destination before commit().
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

// An output file that appears under its name only when complete; a bad path fails at once, before
// long work. Without commit() nothing is left, even if the process is killed: the file has no name
// or, where file systems lack that (NFS), lies beside it as NAME.lamina-N.part, locked; the next
// AtomicFile of this name removes what a killed process left. A replaced file's mode is kept.
class AtomicFile : public OutputFile {
  public:
    explicit AtomicFile(
        std::filesystem::path path);  // throws WriteError if the folder cannot be written
    ~AtomicFile() override;

    // Writes all of the file to disk under a temporary name, so that commit() only renames it:
    // files that belong together then appear together. Throws WriteError.
    void complete();
    void commit() override;  // throws WriteError

  private:
    void close_stream();
    bool open_nameless();  // returns false if the file system does not allow it
    void open_named();
    void keep_mode() const;
    void open_stream();
    void give_name();

    std::filesystem::path temporary_;  // temporary name; empty if there is none
    int descriptor_ = -1;              // open until the end, for its lock and to give it a name
};

// Returns the folder of temporary files: TMPDIR, or /tmp if it is not set.
std::string temporary_folder();

// A temporary file without a name, which disappears with this object or the process.
class TemporaryFile {
  public:
    TemporaryFile();  // throws Error
    ~TemporaryFile() { std::fclose(stream_); }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    std::FILE* stream() const { return stream_; }
    void write(const void* bytes, std::size_t count);  // throws Error
    // Writes out the buffer and goes to the first byte, for any code to read. Throws Error.
    void rewind();

  private:
    std::FILE* stream_ = nullptr;
};

// An output to stdout, kept in a temporary file until commit(): a reader gets all or nothing.
class PipedFile : public OutputFile {
  public:
    PipedFile();             // throws Error
    void commit() override;  // throws Error

  private:
    TemporaryFile file_;
};

// Makes a folder and its parent folders if they do not exist yet. Throws Error.
void make_folder(const std::filesystem::path& folder);

// The files of a folder that a verb wrote itself and may therefore replace. The folder's
// lamina-files.txt lists them, with a line "VERB: NAME" for each file.
class OwnFiles {
  public:
    static constexpr const char* list_name = "lamina-files.txt";

    OwnFiles(std::filesystem::path folder, std::string verb);

    // Throws Error if a file or folder of these names exists that the verb did not write.
    void expect_own(const std::vector<std::string>& names) const;
    // Adds names to the list, and makes the folder if needed. Call it before the files are written:
    // a file not on the list is then never from this verb, even after a kill.
    void add(const std::vector<std::string>& names) const;
    // Removes the files of the verb that are on the list and directly in the folder, the list if no
    // other verb is on it, and the folder if nothing else is in it. Throws Error.
    void remove_all() const;

  private:
    std::set<std::string> listed() const;  // lines of the list
    void write(const std::set<std::string>& lines) const;

    std::filesystem::path folder_;
    std::string verb_;
};

}  // namespace lamina
