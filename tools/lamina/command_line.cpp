// SPDX-License-Identifier: Apache-2.0
#include "command_line.h"

namespace lamina {
namespace {

std::string line;

}  // namespace

void set_command_line(int argc, char** argv) {
    line = "lamina";
    for (int i = 1; i < argc; ++i) line += std::string(" ") + argv[i];
}

const std::string& command_line() {
    return line;
}

}  // namespace lamina
