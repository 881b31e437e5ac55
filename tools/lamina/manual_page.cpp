// SPDX-License-Identifier: Apache-2.0
#include "manual_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

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
    ".TP\n.B LAMINA_INSTRUCTIONS\nKeeps the native engine to these instructions: SSE4, AVX2, AVX3 "
    "or NEON. No picture changes.\n";

// Text as roff prints it: no request at the start of a line, hyphens that can be copied.
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

}  // namespace

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

}  // namespace lamina
