// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "base/output_file.h"

namespace lamina {

// The name of stdout for outputs, and of stdin for scenes.
inline constexpr const char* standard_stream = "-";

// The output that an option names: a file, or stdout. Throws Error if it cannot be written.
std::unique_ptr<OutputFile> open_named(const std::string& name);

}  // namespace lamina
