// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "cli/run_program.h"

namespace lamina {

// Runs `lamina` with these arguments.
inline ProgramResult lamina_run(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), LAMINA_BINARY);
    return run_program(arguments);
}

}  // namespace lamina
