// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

namespace lamina {

// A program of verbs.
struct Program {
    std::string name, description, footer;
    // Declares the verbs, whose callbacks do the work; they may set the exit code.
    std::function<void(CLI::App& app, int& exit_code)> add_verbs;
};

// Does what the command line says, and says on stderr what failed. Returns the exit code
// (base/error.h); does not throw.
int run_command_line(const Program& program, int argc, char** argv);

}  // namespace lamina
