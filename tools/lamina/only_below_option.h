// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

namespace lamina {

// Adds --only-below FOLDER: the verb opens no data outside the folder (base/input_file.h).
void add_only_below_option(CLI::App& verb);

}  // namespace lamina
