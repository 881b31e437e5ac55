// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cli/started_program.h"

namespace lamina {

// Runs the program arguments[0] (searched in PATH) with an empty stdin, waits for its end, and
// returns its output. Exit code 127: it could not be started.
inline ProgramResult run_program(const std::vector<std::string>& arguments,
                                 const std::function<void()>& prepare = {}) {
    return StartedProgram(arguments, prepare).wait();
}

}  // namespace lamina
