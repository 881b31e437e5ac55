// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "completion.h"

namespace lamina {
namespace {

constexpr const char* zsh_frame = R"(#compdef {0}
_{0}() {{
    local -a verbs
    verbs=(
{1}    )
    if (( CURRENT == 2 )); then
        _describe verb verbs
        return
    fi
    local verb=$words[2]
    shift words
    (( CURRENT-- ))
    case $verb in
{2}    esac
}}
_{0} "$@"
)";

// In single quotes, for _describe and _arguments.
std::string zsh_quoted(const std::string& text) {
    std::string result;
    for (const char c : text) {
        if (c == '\'') {
            result += "'\\''";
        } else if (c == '[' || c == ']' || c == ':' || c == '\\') {
            result += std::string("\\") + c;
        } else {
            result += c;
        }
    }
    return result;
}

std::string action_of(const OptionDescription& option) {
    return option.choices.empty() ? "_files" : fmt::format("({})", fmt::join(option.choices, " "));
}

std::string arguments(const CommandDescription& verb) {
    std::string text;
    for (const OptionDescription& option : verb.options) {
        if (option.positional) continue;
        for (const std::string& name : option.names) {
            text += fmt::format(" \\\n                '*{}[{}]", name, zsh_quoted(option.text));
            if (!option.value.empty() && !option.optional_value)
                text += fmt::format(":{}:{}", zsh_quoted(option.value), action_of(option));
            text += "'";
        }
    }
    std::string last = "*:file:_files";
    for (const OptionDescription& option : verb.options)
        if (option.positional && !option.choices.empty())
            last = fmt::format("1:{}:{}", option.names[0], action_of(option));
    return text + " \\\n                '" + last + "'";
}

}  // namespace

std::string zsh_completion(const CommandDescription& program) {
    std::string verbs, cases;
    for (const CommandDescription& verb : program.verbs) {
        const std::string name = verb.name.substr(program.name.size() + 1);
        verbs += fmt::format("        '{}:{}'\n", name, zsh_quoted(verb.text));
        cases += fmt::format("        {})\n            _arguments{}\n            ;;\n", name,
                             arguments(verb));
    }
    return fmt::format(zsh_frame, program.name, verbs, cases);
}

}  // namespace lamina
