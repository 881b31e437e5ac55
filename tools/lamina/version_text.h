// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace lamina {

// What --version prints: version and commit, then a line each for what depends on the build and on
// the machine.
std::string version_text();

}  // namespace lamina
