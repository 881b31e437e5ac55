// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace lamina {

// An option or a positional argument, as the verb declares it to CLI11.
struct OptionDescription {
    std::vector<std::string> names;    // "-o", "--output"; the name of a positional argument
    std::string value;                 // placeholder of its value: "FILE"; empty if it takes none
    std::vector<std::string> choices;  // all values, if they are a fixed list
    std::string text;
    std::string group;
    bool positional = false;
    bool optional_value = false;  // a value must be given as --name=VALUE
};

// A verb, or the program itself.
struct CommandDescription {
    std::string name;  // "lamina render"
    std::string text, footer;
    std::vector<OptionDescription> options;
    std::vector<CommandDescription> verbs;
};

// Returns the verbs, options and texts from which manual pages and completions are made. They are
// the declarations that --help prints.
CommandDescription describe(const CLI::App& app);

}  // namespace lamina
