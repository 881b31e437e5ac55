// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/output_file.h"

namespace lamina {

// Finds the program ffmpeg, which is neither linked nor bundled. Throws Error, which says what to
// install, if it is not there or lacks the encoder ("libx264"). `output`: for messages.
std::filesystem::path require_ffmpeg(const std::string& output, const std::string& encoder);

// A running ffmpeg. It ends with this object, and soon after this process, at the end of its input.
class Ffmpeg {
  public:
    // Starts the program. `files`: open files, which ffmpeg finds as /proc/self/fd/3, 4, ...; they
    // take its result or are further input. Standard output goes into the file `out`, if given.
    Ffmpeg(const std::filesystem::path& program, const std::vector<std::string>& arguments,
           const std::vector<int>& files, std::FILE* out = nullptr);
    ~Ffmpeg();
    Ffmpeg(const Ffmpeg&) = delete;
    Ffmpeg& operator=(const Ffmpeg&) = delete;

    // Writes to its standard input. Throws Error, which says why, if it has ended; Interrupted.
    void write(std::string_view bytes);
    // Ends its input and waits until it ends. Throws Error if it failed; Interrupted.
    void finish();

  private:
    void start(const std::filesystem::path& program, const std::vector<std::string>& arguments,
               const std::vector<int>& files, int in, std::FILE* out);
    void close_input();

    pid_t id_ = -1;
    int input_ = -1;  // end of the pipe to its standard input
    TemporaryFile messages_;
};

}  // namespace lamina
