// SPDX-License-Identifier: Apache-2.0
#include "markdown_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

namespace lamina {
namespace {

constexpr const char* opening =
    "# Commands\n\n"
    "Every verb of `lamina` and its options. `lamina man --markdown` writes this page from the "
    "command line's own "
    "definitions; `lamina VERB --help` and `man lamina-VERB` say the same.\n\n"
    "Exit codes: 0 done; 1 something was wrong with a file, a scene or the machine, one line says "
    "what, and nothing was "
    "written; 2 the command line was wrong; 3 a picture or a test did not keep its bound "
    "(`compare`, `selftest`); 130 and "
    "143 ended by Ctrl-C and SIGTERM.\n\n";

// Text of a table's cell, read as it stands.
std::string cell(const std::string& text) {
    std::string result;
    for (const char c : text) {
        if (std::string_view("|*_<>[]`\\").find(c) != std::string_view::npos) result += '\\';
        result += c == '\n' ? ' ' : c;
    }
    return result;
}

// Inside of code in a table a bar alone needs care.
std::string code(const std::string& text) {
    std::string result = "`";
    for (const char c : text) result += c == '|' ? "\\|" : std::string(1, c);
    return result + "`";
}

std::string names_cell(const OptionDescription& option) {
    std::string text;
    for (const std::string& name : option.names) {
        const bool last = &name == &option.names.back();
        std::string shown = name;
        if (last && !option.positional && !option.value.empty())
            shown += option.optional_value ? "[=" + option.value + "]" : " " + option.value;
        text += (text.empty() ? "" : ", ") + code(shown);
    }
    return text;
}

std::string usage_line(const CommandDescription& verb) {
    std::string text = verb.name + " [OPTIONS]";
    for (const OptionDescription& option : verb.options)
        if (option.positional) text += " " + option.names[0];
    return text;
}

// --help and --version are the same everywhere.
bool is_common(const OptionDescription& option) {
    return std::ranges::any_of(option.names, [](const std::string& name) {
        return name == "--help" || name == "--version";
    });
}

std::string section(const CommandDescription& verb) {
    std::string text =
        fmt::format("## {}\n\n{}.\n\n```text\n{}\n```\n\n| option | what it does |\n|---|---|\n",
                    verb.name, cell(verb.text), usage_line(verb));
    for (const OptionDescription& option : verb.options)
        if (!is_common(option))
            text += fmt::format("| {} | {} |\n", names_cell(option), cell(option.text));
    std::istringstream lines(verb.footer);
    for (std::string line; std::getline(lines, line);)
        if (!line.empty()) text += "\n" + cell(line) + "\n";
    return text;
}

}  // namespace

std::string markdown_page(const CommandDescription& program) {
    std::string text = opening;
    for (const CommandDescription& verb : program.verbs)
        text += section(verb) + (&verb == &program.verbs.back() ? "" : "\n");
    return text;
}

}  // namespace lamina
