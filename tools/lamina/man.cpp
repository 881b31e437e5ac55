// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <sstream>

#include "base/error.h"
#include "base/process.h"
#include "command_description.h"
#include "scene_files/scene_keys.h"
#include "verbs.h"

namespace lamina {
namespace {

constexpr const char* exit_codes =
    ".SH EXIT STATUS\n"
    ".TP\n0\nDone.\n"
    ".TP\n1\nSomething was wrong with a file, a scene or the machine: one line says what was found "
    "and what was expected. Nothing was written.\n"
    ".TP\n2\nThe command line was wrong.\n"
    ".TP\n3\nA picture or a test did not keep its bound (compare, selftest).\n"
    ".TP\n130, 143\nEnded by Ctrl\\-C or SIGTERM.\n";

constexpr const char* environment =
    ".SH ENVIRONMENT\n"
    ".TP\n.B LAMINA_INSTRUCTIONS\nKeeps the cpu engine to these instructions: SSE4, AVX2, AVX3 "
    "or NEON. No picture changes.\n";

// Escapes text for roff: no line begins with a request, and hyphens can be copied.
std::string roff(const std::string& text) {
    std::string result;
    for (const char c : text) {
        if ((c == '.' || c == '\'') && (result.empty() || result.back() == '\n')) result += "\\&";
        if (c == '\\') {
            result += "\\e";
        } else if (c == '-') {
            result += "\\-";
        } else if (c == '\'') {
            result += "\\(aq";
        } else {
            result += c;
        }
    }
    return result;
}

std::string dashed(std::string name) {
    std::replace(name.begin(), name.end(), ' ', '-');
    return name;
}

std::string upper(std::string text) {
    for (char& c : text)
        if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
    return text;
}

std::string heading_of(const OptionDescription& option) {
    std::string text;
    for (const std::string& name : option.names)
        text += (text.empty() ? "\\fB" : ", \\fB") + roff(name) + "\\fR";
    if (option.positional || option.value.empty()) return text;
    const std::string value = fmt::format("\\fI{}\\fR", roff(option.value));
    return text + (option.optional_value ? "[=" + value + "]" : " " + value);
}

std::string entries(const CommandDescription& command, bool positional, const std::string& group) {
    std::string text;
    for (const OptionDescription& option : command.options) {
        if (option.positional != positional || (!positional && option.group != group)) continue;
        text += ".TP\n" + heading_of(option) + "\n" + roff(option.text) + "\n";
    }
    return text;
}

std::string synopsis(const CommandDescription& command) {
    std::string text = fmt::format(".SH SYNOPSIS\n.B {}\n[\\fIOPTIONS\\fR]", roff(command.name));
    if (!command.verbs.empty()) return text + " \\fIVERB\\fR ...\n";
    for (const OptionDescription& option : command.options)
        if (option.positional) text += fmt::format(" \\fI{}\\fR", roff(option.names[0]));
    return text + "\n";
}

std::string options(const CommandDescription& command) {
    std::vector<std::string> groups;
    for (const OptionDescription& option : command.options)
        if (!option.positional &&
            std::find(groups.begin(), groups.end(), option.group) == groups.end())
            groups.push_back(option.group);
    std::string text;
    for (const std::string& group : groups)
        text += fmt::format(".SH {}\n{}", roff(upper(group)), entries(command, false, group));
    return text;
}

std::string verbs(const CommandDescription& command) {
    if (command.verbs.empty()) return "";
    std::string text = ".SH VERBS\n";
    for (const CommandDescription& verb : command.verbs)
        text += fmt::format(".TP\n.BR {} (1)\n{}\n", roff(dashed(verb.name)), roff(verb.text));
    return text;
}

std::string footer(const CommandDescription& command) {
    if (command.footer.empty()) return "";
    std::string text = ".SH NOTES\n";
    std::istringstream lines(command.footer);
    for (std::string line; std::getline(lines, line);)
        if (!line.empty()) text += ".PP\n" + roff(line) + "\n";
    return text;
}

// Returns the page for `man`, section 1, of a verb or of the program. `version`: "lamina 0.1.0".
std::string manual_page(const CommandDescription& command, const std::string& version) {
    const std::string name = roff(dashed(command.name));
    std::string text = fmt::format(".TH {} 1 \"\" \"{}\" \"lamina\"\n.SH NAME\n{} \\- {}\n",
                                   upper(name), roff(version), name, roff(command.text));
    text += synopsis(command) + verbs(command);
    const std::string positionals = entries(command, true, "");
    if (!positionals.empty()) text += ".SH ARGUMENTS\n" + positionals;
    text += options(command) + footer(command) + exit_codes + environment;
    if (command.verbs.empty()) text += ".SH SEE ALSO\n.BR lamina (1)\n";
    return text;
}

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

// Escapes text for a cell of a Markdown table, so that it is shown as it is.
std::string cell(const std::string& text) {
    std::string result;
    for (const char c : text) {
        if (std::string_view("|*_<>[]`\\").find(c) != std::string_view::npos) result += '\\';
        result += c == '\n' ? ' ' : c;
    }
    return result;
}

// Returns code for a cell of a Markdown table. In code only a bar must be escaped.
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

// Tells whether every verb has the option: --help and --version are left out of the tables.
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

// Returns the Markdown page of all verbs (docs/commands.md), which ends with a newline.
std::string markdown_page(const CommandDescription& program) {
    std::string text = opening;
    for (const CommandDescription& verb : program.verbs)
        text += section(verb) + (&verb == &program.verbs.back() ? "" : "\n");
    return text;
}

const CommandDescription& find(const CommandDescription& program, const std::string& verb) {
    if (verb.empty()) return program;
    const auto found = std::find_if(
        program.verbs.begin(), program.verbs.end(),
        [&](const CommandDescription& v) { return v.name == program.name + " " + verb; });
    if (found == program.verbs.end())
        throw UsageError(
            fmt::format("man {}: unknown verb (lamina --help lists them)", shortened(verb)));
    return *found;
}

}  // namespace

void add_man(CLI::App& app, int&) {
    struct Options {
        std::string name;
        bool markdown = false, schema = false;
    };
    const auto options = std::make_shared<Options>();
    CLI::App* const verb =
        app.add_subcommand("man", "Print the manual page of the program, or of a verb");
    verb->add_option("VERB", options->name, "The verb; without one the page of lamina itself");
    verb->add_flag("--markdown", options->markdown, "Print all verbs as one page of Markdown");
    verb->add_flag("--scene-schema", options->schema,
                   "Print the JSON schema of scene files, for editors");
    verb->footer("To read it: lamina man render | man -l -");
    verb->callback([&app, options] {
        if (options->markdown && !options->name.empty())
            throw UsageError("man --markdown: has all verbs, expected no VERB beside it");
        if (options->schema && (options->markdown || !options->name.empty()))
            throw UsageError("man --scene-schema: is no page, expected nothing beside it");
        if (options->schema) return write_result(scene_schema_text());
        write_result(options->markdown ? markdown_page(describe(app))
                                       : manual_page(find(describe(app), options->name),
                                                     "lamina " LAMINA_VERSION));
    });
}

}  // namespace lamina
