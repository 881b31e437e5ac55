// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

namespace lamina {

// Adds --memory SIZE, which sets the memory limit (base/memory.h) when the command line is
// read.
void add_memory_option(CLI::App& verb);

}  // namespace lamina
