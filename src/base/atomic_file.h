// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "base/output_file.h"

namespace lamina {

// An output file that appears under its name only when it is complete. It is opened before long
// work begins, so that a path that cannot be written fails at once. Without commit() nothing is
// left behind, not even when the process is killed, because until then the file has no name where
// the file system allows that. Where it does not (NFS), and during commit(), the file lies beside
// its destination as NAME.lamina-N.part and is locked. If a killed process leaves such a file
// there, the next one of this name removes it. A file that is replaced keeps its mode.
class AtomicFile : public OutputFile {
  public:
    explicit AtomicFile(
        std::filesystem::path path);  // throws WriteError when the folder cannot be written
    ~AtomicFile() override;

    // Writes all of the file to disk under a temporary name beside its destination. This is for
    // files that belong together, whose commit() is then only a renaming. Throws WriteError.
    void complete();
    void commit() override;  // throws WriteError

  private:
    void close_stream();
    bool open_nameless();  // false where the file system does not allow it
    void open_named();
    void keep_mode() const;
    void open_stream();
    void give_name();

    std::filesystem::path temporary_;  // temporary name; empty where there is none
    int descriptor_ = -1;              // open until the end, for its lock and to give it a name
};

}  // namespace lamina
