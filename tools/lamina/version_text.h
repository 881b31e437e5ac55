// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace lamina {

// Returns the text of --version: version and commit, then a line for each property of the build and
// of the machine.
std::string version_text();

}  // namespace lamina
