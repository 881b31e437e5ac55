// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cli/run_program.h"

namespace lamina {

// Runs `lamina` with these arguments.
inline ProgramResult lamina_run(std::vector<std::string> arguments,
                                const std::function<void()>& prepare = {}) {
    arguments.insert(arguments.begin(), LAMINA_BINARY);
    return run_program(arguments, prepare);
}

}  // namespace lamina
