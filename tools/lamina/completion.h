// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "command_description.h"

namespace lamina {

// Returns scripts by which a shell completes the program's verbs, options and the values of options
// that are fixed lists; other values are completed as files.
std::string bash_completion(const CommandDescription& program);
std::string zsh_completion(const CommandDescription& program);
std::string fish_completion(const CommandDescription& program);

}  // namespace lamina
