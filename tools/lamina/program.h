// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

namespace lamina {

// Sets and returns the command line of this process, for reports: "lamina study ...".
void set_command_line(int argc, char** argv);
const std::string& command_line();

// Returns the text of --version: version and commit, then a line for each property of the build and
// the machine.
std::string version_text();

// A program whose first argument is a verb.
struct Program {
    std::string name, description, footer;
    // Declares the verbs. Their callbacks do the work and may set the exit code.
    std::function<void(CLI::App& app, int& exit_code)> add_verbs;
};

// Runs the verb of the command line, and prints failures on stderr. Returns the exit code
// (base/error.h). Does not throw.
int run_command_line(const Program& program, int argc, char** argv);

}  // namespace lamina
