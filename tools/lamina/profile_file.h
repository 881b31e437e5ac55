// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "base/atomic_file.h"
#include "base/profile.h"

namespace lamina {

// A profile of the program from here on, for a file in Chrome's trace event format, which
// Perfetto and chrome://tracing open.
class ProfileFile {
  public:
    explicit ProfileFile(const std::filesystem::path& path) : file_(path) {}  // throws Error

    // The title of it all, and what drew. Returns how many spans were too many to be kept: the file
    // says so, too.
    std::int64_t write(const std::string& title, const std::string& context);

  private:
    AtomicFile file_;
    Profile profile_;
    std::int64_t start_ns_ = Stopwatch::now();
};

}  // namespace lamina
