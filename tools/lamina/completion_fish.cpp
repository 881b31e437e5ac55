// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "completion.h"

namespace lamina {
namespace {

std::string fish_quoted(const std::string& text) {
    std::string result = "'";
    for (const char c : text) {
        if (c == '\'' || c == '\\') result += '\\';
        result += c;
    }
    return result + "'";
}

std::string line_of(const std::string& program, const std::string& condition,
                    const OptionDescription& option) {
    std::string line = fmt::format("complete -c {} -n {}", program, fish_quoted(condition));
    if (option.positional)
        return line + fmt::format(" -f -a '{}'\n", fmt::join(option.choices, " "));
    for (const std::string& name : option.names)
        line += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
    if (!option.choices.empty()) {
        line += fmt::format(" -x -a '{}'", fmt::join(option.choices, " "));
    } else if (!option.value.empty() && !option.optional_value) {
        line += " -r -F";
    }
    return line + " -d " + fish_quoted(option.text) + "\n";
}

}  // namespace

std::string fish_completion(const CommandDescription& program) {
    std::string text = fmt::format("# fish completion of {}\n", program.name);
    for (const CommandDescription& verb : program.verbs) {
        const std::string name = verb.name.substr(program.name.size() + 1);
        text += fmt::format("complete -c {} -f -n __fish_use_subcommand -a {} -d {}\n",
                            program.name, name, fish_quoted(verb.text));
        for (const OptionDescription& option : verb.options)
            if (!option.positional || !option.choices.empty())
                text += line_of(program.name, "__fish_seen_subcommand_from " + name, option);
    }
    return text;
}

}  // namespace lamina
