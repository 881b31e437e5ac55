// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>

namespace lamina {

// --only-below FOLDER: files outside the folder are not opened (base/file_bytes.h).
void add_only_below_option(CLI::App& verb);

// The folder that the command line names; empty until it was read, and where it names none.
const std::filesystem::path& only_below_folder();

}  // namespace lamina
