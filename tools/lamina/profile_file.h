// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "base/output_file.h"
#include "base/profile.h"
#include "named_output.h"

namespace lamina {

// A profile of the program from here on, for a file in Chrome's trace event format, which
// Perfetto and chrome://tracing open.
class ProfileFile {
  public:
    // Throws Error if the file cannot be written.
    explicit ProfileFile(const std::string& name) : file_(open_named(name)) {}

    // The title of it all, and what drew. Returns how many spans were too many to be kept: the file
    // says so, too.
    std::int64_t write(const std::string& title, const std::string& context);

  private:
    std::unique_ptr<OutputFile> file_;
    Profile profile_;
    std::int64_t start_ns_ = Stopwatch::now();
};

}  // namespace lamina
