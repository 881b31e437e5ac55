// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "command_description.h"

namespace lamina {

// Returns the page for `man`, section 1, of a verb or of the program. `version`: "lamina 0.1.0".
std::string manual_page(const CommandDescription& command, const std::string& version);

}  // namespace lamina
