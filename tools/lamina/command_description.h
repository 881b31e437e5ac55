// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace lamina {

// An option or a positional argument, as the command line declares it.
struct OptionDescription {
    std::vector<std::string> names;    // "-o", "--output"; of a positional its name alone
    std::string value;                 // what stands for its value: "FILE"; empty: it takes none
    std::vector<std::string> choices;  // the values that there are, where they are a fixed list
    std::string text;
    std::string group;
    bool positional = false;
    bool optional_value = false;  // only as --name=VALUE
};

// A verb, or the program itself.
struct CommandDescription {
    std::string name;  // "lamina render"
    std::string text, footer;
    std::vector<OptionDescription> options;
    std::vector<CommandDescription> verbs;
};

// Verbs, options and texts that manual pages and completions are made from: the declarations that
// --help prints.
CommandDescription describe(const CLI::App& app);

}  // namespace lamina
