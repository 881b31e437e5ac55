// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace lamina {

// Where the program is that was built or installed with this one: beside the program that runs,
// where the library's programs are installed, else in the PATH.
std::optional<std::filesystem::path> find_program(const std::string& name);

}  // namespace lamina
