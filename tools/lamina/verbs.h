// SPDX-License-Identifier: Apache-2.0
// The verbs of the program, one file each. add_X() declares the verb's options; its callback does
// the work and throws Error (exit 1) or UsageError (exit 2), or sets the exit code for an outcome
// that is neither (compare, selftest: 3).
#pragma once

#include <CLI/CLI.hpp>

namespace lamina {

void add_verbs(CLI::App& app, int& exit_code);  // all of the below

void add_render(CLI::App& app, int& exit_code);
void add_view(CLI::App& app, int& exit_code);
void add_compare(CLI::App& app, int& exit_code);
void add_mesh(CLI::App& app, int& exit_code);
void add_generate(CLI::App& app, int& exit_code);
void add_index(CLI::App& app, int& exit_code);
void add_info(CLI::App& app, int& exit_code);
void add_integrate(CLI::App& app, int& exit_code);
void add_scene(CLI::App& app, int& exit_code);
void add_order(CLI::App& app, int& exit_code);
void add_reproduce(CLI::App& app, int& exit_code);
void add_study(CLI::App& app, int& exit_code);
void add_crosscheck(CLI::App& app, int& exit_code);
void add_selftest(CLI::App& app, int& exit_code);
void add_completion(CLI::App& app, int& exit_code);
void add_man(CLI::App& app, int& exit_code);

}  // namespace lamina
