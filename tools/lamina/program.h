// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

namespace lamina {

// Returns the command line of this process, for reports: "lamina study ...".
void set_command_line(int argc, char** argv);
const std::string& command_line();

// Returns the text of --version: version and commit, then a line for each property of the build and
// of the machine.
std::string version_text();

// A program whose first argument is a verb.
struct Program {
    std::string name, description, footer;
    // Declares the verbs, whose callbacks do the work; they may set the exit code.
    std::function<void(CLI::App& app, int& exit_code)> add_verbs;
};

// Runs the verb of the command line, and prints on stderr what failed. Returns the exit code
// (base/error.h); does not throw.
int run_command_line(const Program& program, int argc, char** argv);

}  // namespace lamina
