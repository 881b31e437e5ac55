// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "lamina/grid.h"
#include "volume_files/isolated_process.h"
#include "volume_files/stored_samples.h"

namespace lamina {

// What a reader has taken of a file.
struct ReadSamples {
    Grid grid;
    StoredSamples samples;
};

// Calls `read` in a process of its own (volume_files/isolated_process.h). Its samples are in the
// line's shared_memory(). `name`: of the file, for messages. Throws Error.
ReadSamples read_isolated(const std::string& name, const char* library,
                          const std::function<ReadSamples(IsolatedLine&)>& read);

}  // namespace lamina
