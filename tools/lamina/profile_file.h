// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "base/output_file.h"
#include "base/profile.h"
#include "named_output.h"

namespace lamina {

// A profile of the program from its construction on, as a file in Chrome's trace event format,
// which Perfetto and chrome://tracing open.
class ProfileFile {
  public:
    // Throws Error if the file cannot be written.
    explicit ProfileFile(const std::string& name) : file_(open_named(name)) {}

    // Writes the file. `title`: of the whole; `context`: what drew. Returns the number of spans
    // that were too many to be kept, which the file states, too.
    std::int64_t write(const std::string& title, const std::string& context);

  private:
    std::unique_ptr<OutputFile> file_;
    Profile profile_;
    std::int64_t start_ns_ = Stopwatch::now();
};

}  // namespace lamina
