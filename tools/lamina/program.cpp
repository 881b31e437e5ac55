// SPDX-License-Identifier: Apache-2.0
#include "program.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <new>
#include <optional>
#include <set>
#include <sstream>
#include <string_view>
#include <system_error>
#include <vector>

#include "base/client.h"
#include "base/error.h"
#include "base/large_stack.h"
#include "base/process.h"
#include "git_commit.h"
#include "lamina/words.h"
#include "mesh_files/mesh_file.h"
#include "shared_options.h"
#include "simd/instruction_set.h"
#include "volume_files/volume_file.h"

namespace lamina {
namespace {

std::string given_line;

std::string found_programs() {
    std::vector<std::string> parts;
    for (const char* const name : {"lamina-tetrahedralize", "lamina-view"}) {
        const auto program = find_program(name);
        parts.push_back(fmt::format("{} ({})", name, program ? program->string() : "not found"));
    }
    return fmt::format("{}", fmt::join(parts, ", "));
}

// Shortens a message that may quote a long input. Its beginning says what is wrong and its end what
// is expected, so both stay.
std::string of_bounded_length(const std::string& message) {
    constexpr std::size_t most = 2000, most_of_end = 500;  // bytes: far more than any message needs
    if (message.size() <= most) return message;
    return shortened(message, most - most_of_end) + message.substr(message.size() - most_of_end);
}

int report(const std::string& message, int exit_code) {
    print_message("lamina: {}\n", of_bounded_length(message));
    return exit_code;
}

// Prints a warning once, even if several pictures repeat it.
void print_warning(const std::string& text, std::set<std::string>& printed) {
    if (Progress::is_quiet() || !printed.insert(text).second) return;
    print_message("lamina: warning: {}\n", of_bounded_length(text));
}

// Memory kept in reserve until an allocation fails. Destructors of nested JSON values allocate, and
// an exception that leaves a destructor ends the process; while the stack unwinds they use this
// memory. It is large enough for malloc to map it separately, so that free() returns all of it.
constexpr std::size_t reserve_bytes = 256 << 10;
std::atomic<void*> reserve = nullptr;

// Called by operator new when memory is out: frees the reserve, then throws.
void release_reserve() {
    std::free(reserve.exchange(nullptr));
    throw std::bad_alloc();
}

std::set<std::string> verbs_of(const CLI::App& app) {
    std::set<std::string> names;
    for (const CLI::App* const verb : app.get_subcommands({})) names.insert(verb->get_name());
    return names;
}

// Tells whether the text names data that are there: a file or a folder, or an array in one.
bool names_data(const std::string& text) {
    std::error_code unknown;
    return std::filesystem::exists(text, unknown) ||
           std::filesystem::exists(text.substr(0, text.rfind(':')), unknown);
}

bool has_display() {
    for (const char* const name : {"DISPLAY", "WAYLAND_DISPLAY"}) {
        const char* const display = std::getenv(name);
        if (display != nullptr && *display != '\0') return true;
    }
    return false;
}

// Returns the arguments with the verb `view` before a file that stands without a verb. Throws
// UsageError if it cannot be shown, and for an unknown verb: CLI11 would only say that a subcommand
// is missing.
std::vector<char*> with_verb(const CLI::App& app, int argc, char** argv) {
    static char view[] = "view";
    std::vector<char*> arguments(argv, argv + argc);
    const bool is_option = argc > 1 && argv[1][0] == '-';
    if (argc < 2 || (is_option && app.get_option_no_throw(argv[1]) == nullptr)) {
        throw UsageError(fmt::format("{}expected a verb, one of {} ({} --help shows the usage)",
                                     is_option ? std::string(argv[1]) + ": " : "",
                                     fmt::join(verbs_of(app), ", "), app.get_name()));
    }
    if (is_option) return arguments;
    const std::string first = argv[1];
    if (first == "help") {  // "help VERB" is "VERB --help"
        static char help[] = "--help";
        arguments.erase(arguments.begin() + 1);
        arguments.resize(std::min<std::size_t>(arguments.size(), 2));
        arguments.push_back(help);
        return arguments.size() == 2
                   ? arguments
                   : with_verb(app, static_cast<int>(arguments.size()), arguments.data());
    }
    bool can_view = false;
    for (const CLI::App* const verb : app.get_subcommands({})) {
        if (verb->get_name() == first) return arguments;
        can_view |= verb->get_name() == view;
    }
    if (!can_view || !names_data(first)) {
        throw UsageError(fmt::format("{}: unknown verb{} ({} --help shows the usage)", first,
                                     suggestion(verbs_of(app), first), app.get_name()));
    }
    const char* const problem = !has_display()                 ? "there is no display to show it on"
                                : !find_program("lamina-view") ? "lamina-view is not installed"
                                                               : nullptr;
    if (problem != nullptr) {
        throw UsageError(
            fmt::format("{}: {}: lamina render {} -o a.png draws it", first, problem, first));
    }
    arguments.insert(arguments.begin() + 1, view);
    return arguments;
}

// Gives the word `headlight` to each --light that a file follows: CLI11 takes the file for the
// word.
void fill_in_light(std::vector<char*>& arguments) {
    static char filled[] = "--light=headlight";
    const std::vector<std::string> known = known_words("light");
    for (std::size_t i = 1; i + 1 < arguments.size(); ++i) {
        const std::string next = arguments[i + 1];
        if (std::string_view(arguments[i]) != "--light" || std::ranges::count(known, next) > 0)
            continue;
        const bool file = next == "-" || next.find_first_of("./") != next.npos || names_data(next);
        if (file) arguments[i] = filled;
    }
}

// Tells if a text looks like an option, not like a value: -30, -x, - and -1:2 are values.
bool is_option(const CLI::App& verb, const std::string& text) {
    const std::string name = text.substr(0, text.find('='));
    if (name.size() > 2 && name.starts_with("--")) {
        return std::isalpha(static_cast<unsigned char>(name[2])) != 0 &&
               std::ranges::all_of(name, [](unsigned char letter) {
                   return std::isalnum(letter) != 0 || letter == '-' || letter == '_' ||
                          letter == '.';
               });
    }
    return name.starts_with("-") && verb.get_option_no_throw(name) != nullptr;
}

// Throws UsageError if an option follows one that needs a value: CLI11 takes it for the value.
void check_values(const CLI::App& app, const std::vector<char*>& arguments) {
    const std::vector<const CLI::App*> verbs =
        app.get_subcommands([&](const CLI::App* verb) { return verb->get_name() == arguments[1]; });
    if (verbs.empty()) return;
    const CLI::App* const verb = verbs.front();
    for (std::size_t i = 2; i + 1 < arguments.size(); ++i) {
        const std::string name = arguments[i], next = arguments[i + 1];
        if (name == "--") return;
        const CLI::Option* const option =
            name.starts_with("-") ? verb->get_option_no_throw(name) : nullptr;
        if (option == nullptr || option->get_items_expected_min() == 0) continue;
        if (is_option(*verb, next)) {
            const std::string joined = name + (name.starts_with("--") ? "=" : "") + next;
            throw UsageError(
                fmt::format("{}: found the option {}, expected a value ({} if it is the value)",
                            name, shortened(next), shortened(joined)));
        }
        ++i;
    }
}

// Words that a script leaves empty would count as not given.
std::string not_empty(const std::string& text) {
    return text.empty() ? "found '', expected a value" : "";
}

// Tells if this is what CLI11 says of an option whose words are no number of its type.
bool is_about(const CLI::Option& option, const CLI::ParseError& error) {
    return std::string_view(error.what()) ==
           CLI::ConversionError(option.get_name(), option.results()).what();
}

// Returns what CLI11 says of words that are no number, in lamina's form; nothing of other errors.
std::optional<std::string> text_of_number(const CLI::ParseError& error, const CLI::App& app) {
    for (const CLI::App* const verb : app.get_subcommands()) {
        for (const CLI::Option* const option : verb->get_options()) {
            if (!is_about(*option, error)) continue;
            const std::string found = one_line(CLI::detail::join(option->results()));
            double number = 0;
            const bool is_fraction = CLI::detail::lexical_cast(found, number);
            return fmt::format("{}: found {}, expected a {}", option->get_name(), shortened(found),
                               is_fraction ? "whole number" : "number");
        }
    }
    return std::nullopt;
}

// Returns what is wrong with a word that no option takes: a setting without "=", a second file, or
// a picture without -o.
std::string text_of_extra(const std::string& word, const CLI::App& verb) {
    if (const CLI::Option* const set = verb.get_option_no_throw("--set")) {
        for (const std::string& setting : set->results()) {
            if (setting.find('=') == setting.npos)
                return fmt::format("--set {}: expected KEY=VALUE, did you mean --set {}={}?",
                                   shortened(setting), shortened(setting), shortened(word));
        }
    }
    const CLI::Option* const output = verb.get_option_no_throw("--output");
    if (output == nullptr) return word + ": not expected here";
    if (output->empty()) return fmt::format("{0}: not expected here, did you mean -o {0}?", word);
    const std::string from = std::filesystem::path(word).extension().string(),
                      to = std::filesystem::path(output->as<std::string>()).extension().string();
    if (!names_data(word) || from.empty() || to.empty()) return word + ": not expected here";
    return fmt::format(
        "{0}: not expected here: lamina {1} takes one file at a time, as in for f in *{2}; do "
        "lamina {1} \"$f\" -o \"${{f%.*}}{3}\"; done",
        word, verb.get_name(), from, to);
}

// Returns what is missing if it is an option or a file that a verb needs, with its help's first
// words; nothing of other errors.
std::optional<std::string> text_of_missing(const CLI::ParseError& error, const CLI::App& app) {
    if (dynamic_cast<const CLI::RequiredError*>(&error) == nullptr) return std::nullopt;
    for (const CLI::App* const verb : app.get_subcommands()) {
        for (const CLI::Option* const option : verb->get_options()) {
            if (CLI::RequiredError(option->get_name()).what() != std::string_view(error.what()) ||
                (!option->get_positional() && option->get_snames().empty()))
                continue;
            std::string name = option->get_name();
            if (!option->get_positional()) name = "-" + option->get_snames().front();
            if (const std::string& text = option->get_option_text(); !text.empty())
                name += " " + text;
            std::string help = option->get_description();
            help.resize(std::min(help.size(), help.find_first_of(";(")));
            while (help.ends_with(' ')) help.pop_back();
            return fmt::format("{}: expected {}: {}", verb->get_name(), name, help);
        }
    }
    return std::nullopt;
}

// Returns what CLI11 found wrong, for people.
std::string text_of(const CLI::ParseError& error, const CLI::App& app) {
    const std::string text = one_line(error.what());
    const std::string_view twice = ": At Most 1 required but received ";
    if (const std::size_t at = text.find(twice); at != text.npos) {
        return fmt::format("{}: found {} times, expected once", text.substr(0, at),
                           text.substr(at + twice.size()));
    }
    if (const auto number = text_of_number(error, app)) return *number;
    if (const auto missing = text_of_missing(error, app)) return *missing;
    if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr && text.ends_with(" missing"))
        return text.substr(0, text.find(':')) + ": expected a value after it";
    if (dynamic_cast<const CLI::ExtrasError*>(&error) == nullptr) return text;
    for (const CLI::App* const verb : app.get_subcommands()) {
        std::set<std::string> known;
        for (const CLI::Option* const option : verb->get_options())
            for (const std::string& name : option->get_lnames()) known.insert("--" + name);
        const std::vector<std::string> extras = verb->remaining();
        if (extras.empty()) continue;
        const std::string& first = extras.front();
        if (!first.starts_with("-")) return text_of_extra(first, *verb);
        // A list of all options would say less than --help. -size is --size with a dash missing.
        const std::string whole = first.substr(0, first.find('='));
        const bool is_word = !whole.starts_with("--") && whole.size() > 2;
        const std::string meant = (is_word ? "-" : "") + whole;
        if (verb->get_option_no_throw("--set") != nullptr && !known.contains(meant)) {
            std::string word = whole.substr(whole.find_first_not_of('-'));
            std::ranges::replace(word, '-', '_');
            if (const std::string key = scene_key_named(word); !key.empty())
                return fmt::format("{}: no such option, did you mean --set {}=VALUE?", first, key);
        }
        const std::string near = suggestion(known, meant);
        return fmt::format("{}: no such option{}", first, near.starts_with(", did") ? near : "");
    }
    return text;
}

int run(const Program& program, int argc, char** argv) {
    int exit_code = 0;
    CLI::App app(program.description, program.name);
    app.set_version_flag("--version", version_text);
    app.footer(program.footer);
    app.require_subcommand(1);
    program.add_verbs(app, exit_code);
    for (CLI::App* const verb : app.get_subcommands({})) {
        verb->set_version_flag("--version", version_text);
        // --help shows no type beside positional arguments: their names suffice.
        for (CLI::Option* const option : verb->get_options()) {
            // Before the verb's own checks, so that they get a text.
            if (option->get_expected_max() > 0)
                option->transform(CLI::Validator(not_empty, "", ""));
            if (option->get_positional()) option->type_name("");
        }
    }
    std::vector<char*> arguments = with_verb(app, argc, argv);
    fill_in_light(arguments);
    check_values(app, arguments);
    try {
        app.parse(static_cast<int>(arguments.size()), arguments.data());
    } catch (const CLI::Success& success) {  // --help, --version
        std::ostringstream text;
        exit_code = app.exit(success, text, text);
        write_result(text.str());
    } catch (const CLI::ParseError& error) {
        const std::vector<CLI::App*> verbs = app.get_subcommands();
        const std::string verb = verbs.empty() ? "" : " " + verbs.front()->get_name();
        return report(fmt::format("{} ({}{} --help shows the usage)", text_of(error, app),
                                  program.name, verb),
                      2);
    }
    flush_results();
    return exit_code;
}

// Runs the verb and reports failures. Does not throw.
int run_and_report(const Program& program, int argc, char** argv, const SignalStop& signals) {
    std::set<std::string> printed;
    const WarningTaker print = [&](const std::string& text) { print_warning(text, printed); };
    const ClientScope scope({.stop = signals.token(), .warnings = &print});
    try {
        return run(program, argc, argv);
    } catch (const UsageError& error) {
        return report(error.what(), 2);
    } catch (const Interrupted& interrupted) {
        return report(interrupted.what(), signals.exit_code());
    } catch (const std::bad_alloc&) {
        std::fputs("lamina: out of memory\n", stderr);  // allocates nothing
        return 1;
    } catch (const std::exception& error) {
        return report(error_text(error), 1);
    }
}

}  // namespace

void set_command_line(int argc, char** argv) {
    given_line = "lamina";
    for (int i = 1; i < argc; ++i) given_line += std::string(" ") + argv[i];
}

const std::string& command_line() {
    return given_line;
}

std::string version_text() {
    return fmt::format("lamina " LAMINA_VERSION
                       "\ncommit: {}\ninstructions: {} (this machine has {})\nvolumes: {}\nmeshes: "
                       "{}\nprograms: {}",
                       git_commit, instruction_set(), fmt::join(instruction_sets(), ", "),
                       volume_format_names(), mesh_format_list, found_programs());
}

int run_command_line(const Program& program, int argc, char** argv) {
    make_streams_safe();
    reserve = std::malloc(reserve_bytes);
    std::set_new_handler(release_reserve);
    set_command_line(argc, argv);
    try {
        const SignalStop signals;
        return with_large_stack([&] { return run_and_report(program, argc, argv, signals); });
    } catch (const std::system_error& error) {
        return report(error_text(error), 1);
    }
}

}  // namespace lamina
