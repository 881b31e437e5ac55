// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cli/started_program.h"

namespace lamina {

// Runs the program arguments[0] (looked for in PATH) with an empty stdin, waits for its end, and
// keeps what it wrote. Exit code 127: the program could not be started.
inline ProgramResult run_program(const std::vector<std::string>& arguments,
                                 const std::function<void()>& prepare = {}) {
    return StartedProgram(arguments, prepare).wait();
}

}  // namespace lamina
