// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "completion.h"

namespace lamina {
namespace {

constexpr const char* bash_frame = R"(# bash completion of {0}
_{0}() {{
    local word="${{COMP_WORDS[COMP_CWORD]}}" before="${{COMP_WORDS[COMP_CWORD-1]}}"
    COMPREPLY=()
    if [ "$COMP_CWORD" -eq 1 ]; then
        mapfile -t COMPREPLY < <(compgen -W "{1}" -- "$word")
        return
    fi
    case "${{COMP_WORDS[1]}} $before" in
{2}    esac
    if [[ "$word" == -* ]]; then
        case "${{COMP_WORDS[1]}}" in
{3}        esac
    else
        compopt -o filenames
        mapfile -t COMPREPLY < <(compgen -f -- "$word")
        case "${{COMP_WORDS[1]}}" in
{4}        esac
    fi
}}
complete -F _{0} {0}
)";

std::string names_of(const CommandDescription& verb) {
    std::string names;
    for (const OptionDescription& option : verb.options) {
        if (option.positional) continue;
        for (const std::string& name : option.names) names += (names.empty() ? "" : " ") + name;
    }
    return names;
}

// A case of the verb `name`.
std::string offer(const std::string& name, const std::string& words) {
    return fmt::format(
        "            {}) mapfile -t COMPREPLY < <(compgen -W \"{}\" -- \"$word\") ;;\n", name,
        words);
}

}  // namespace

std::string bash_completion(const CommandDescription& program) {
    std::string verbs, values, options, arguments;
    for (const CommandDescription& verb : program.verbs) {
        const std::string name = verb.name.substr(program.name.size() + 1);
        verbs += name + " ";
        options += offer(name, names_of(verb));
        for (const OptionDescription& option : verb.options) {
            if (option.choices.empty()) continue;
            const std::string choices = fmt::format("{}", fmt::join(option.choices, " "));
            if (option.positional) {
                arguments += offer(name, choices);
                continue;
            }
            for (const std::string& option_name : option.names)
                values += fmt::format(
                    "        \"{} {}\") mapfile -t COMPREPLY < <(compgen -W \"{}\" -- \"$word\"); "
                    "return ;;\n",
                    name, option_name, choices);
        }
    }
    return fmt::format(bash_frame, program.name, verbs + names_of(program), values, options,
                       arguments);
}

}  // namespace lamina
