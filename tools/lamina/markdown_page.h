// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "command_description.h"

namespace lamina {

// Returns all verbs of a program as one page of Markdown (docs/commands.md), which ends with a
// newline.
std::string markdown_page(const CommandDescription& program);

}  // namespace lamina
