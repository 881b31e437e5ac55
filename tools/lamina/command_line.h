// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace lamina {

// Returns the command line of this process, for reports: "lamina study ...".
void set_command_line(int argc, char** argv);
const std::string& command_line();

}  // namespace lamina
