// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <memory>

#include "base/error.h"
#include "base/process.h"
#include "command_description.h"
#include "verbs.h"

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

// Returns the bash case that completes the verb `name` by `words`.
std::string offer(const std::string& name, const std::string& words) {
    return fmt::format(
        "            {}) mapfile -t COMPREPLY < <(compgen -W \"{}\" -- \"$word\") ;;\n", name,
        words);
}

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

// Returns the text in single quotes, escaped for _describe and _arguments of zsh.
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

void run(const CommandDescription& program, const std::string& shell) {
    if (shell == "bash") return write_result(bash_completion(program));
    if (shell == "zsh") return write_result(zsh_completion(program));
    if (shell == "fish") return write_result(fish_completion(program));
    throw UsageError(fmt::format("completion {}: expected bash, zsh or fish", shortened(shell)));
}

}  // namespace

void add_completion(CLI::App& app, int&) {
    const auto shell = std::make_shared<std::string>();
    CLI::App* const verb = app.add_subcommand(
        "completion", "Print the script by which a shell completes this command line");
    verb->add_option("SHELL", *shell, "The shell")->option_text("bash|zsh|fish")->required();
    verb->footer(
        "For this shell alone: source <(lamina completion bash). "
        "For good: where the shell looks for such scripts.");
    verb->callback([&app, shell] { run(describe(app), *shell); });
}

}  // namespace lamina
