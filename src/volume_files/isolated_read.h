// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "lamina/grid.h"
#include "volume_files/stored_samples.h"

namespace lamina {

// What a reader has taken of a file.
struct ReadSamples {
    Grid grid;
    StoredSamples samples;
};

// Allows more processor time and memory to a read in a process of its own: those of headers, and
// those of so many bytes of samples.
void allow_bytes(std::size_t bytes);

// For the samples, once, in `read`: memory that both processes see.
std::shared_ptr<void> shared_sample_memory(std::size_t bytes);

// Calls `read` in a process of its own, because `library` may crash at a damaged file, or never
// end: both become an Error. Its warnings and its Error are passed on. `read` must start no
// threads, and its samples be in shared_sample_memory(). `name`: of the file, for messages. The
// process ends when the client requests a stop.
ReadSamples read_isolated(const std::string& name, const char* library,
                          const std::function<ReadSamples()>& read);

}  // namespace lamina
