// SPDX-License-Identifier: Apache-2.0
#include "command_line.h"

namespace lamina {
namespace {

std::string given_line;

}  // namespace

void set_command_line(int argc, char** argv) {
    given_line = "lamina";
    for (int i = 1; i < argc; ++i) given_line += std::string(" ") + argv[i];
}

const std::string& command_line() {
    return given_line;
}

}  // namespace lamina
