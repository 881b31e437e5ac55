// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

namespace lamina {

// Adds all verbs of the program; CMakeLists.txt lists them. Each has a file of its name with a
// function `void add_VERB(CLI::App& app, int& exit_code)`: it declares the verb's options and the
// callback that does the work. The callback throws Error (exit 1) or UsageError (exit 2), or sets
// the exit code for another outcome (compare, selftest: 3).
void add_verbs(CLI::App& app, int& exit_code);

}  // namespace lamina
