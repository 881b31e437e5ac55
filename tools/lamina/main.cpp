// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <new>
#include <set>
#include <sstream>
#include <string>
#include <system_error>

#include "base/client.h"
#include "base/error.h"
#include "base/large_stack.h"
#include "base/progress.h"
#include "base/signal_stop.h"
#include "base/standard_streams.h"
#include "base/warning.h"
#include "command_line.h"
#include "verbs.h"
#include "version_text.h"

namespace {

int report(const std::string& message, int exit_code) {
    lamina::print_message("lamina: {}\n", message);
    return exit_code;
}

// Each warning is printed once, although a file may be read for many pictures.
void print_warning(const std::string& text) {
    static std::set<std::string> printed;
    if (lamina::Progress::is_quiet() || !printed.insert(text).second) return;
    lamina::print_message("lamina: warning: {}\n", text);
}

// Names an unknown verb. CLI11 would only say that a subcommand is missing.
void check_verb(const CLI::App& app, int argc, char** argv) {
    if (argc < 2 || argv[1][0] == '-') return;
    std::string verbs;
    for (const CLI::App* const verb : app.get_subcommands({})) {
        if (verb->get_name() == argv[1]) return;
        verbs += (verbs.empty() ? "" : ", ") + verb->get_name();
    }
    throw lamina::UsageError(fmt::format(
        "{}: unknown verb, expected one of {} (lamina --help shows the usage)", argv[1], verbs));
}

int run(int argc, char** argv) {
    int exit_code = 0;
    CLI::App app("lamina: volume rendering by slicing, with the error of each picture", "lamina");
    app.set_version_flag("--version", lamina::version_text);
    app.footer(
        "A first picture: lamina render head.nrrd -o head.png\n"
        "What a verb takes: lamina VERB --help");
    app.require_subcommand(1);
    lamina::add_verbs(app, exit_code);
    for (CLI::App* const verb : app.get_subcommands({}))
        verb->set_version_flag("--version", lamina::version_text);
    check_verb(app, argc, argv);
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& success) {  // --help, --version
        std::ostringstream text;
        exit_code = app.exit(success, text, text);
        lamina::write_result(text.str());
    } catch (const CLI::ParseError& error) {
        return report(lamina::one_line(error.what()) + " (lamina --help shows the usage)", 2);
    }
    lamina::flush_results();
    return exit_code;
}

// Does not throw.
int run_and_report(int argc, char** argv, const lamina::SignalStop& signals) {
    const lamina::ClientScope scope({.stop = signals.token()});
    try {
        return run(argc, argv);
    } catch (const lamina::UsageError& error) {
        return report(error.what(), 2);
    } catch (const lamina::Interrupted& interrupted) {
        return report(interrupted.what(), signals.exit_code());
    } catch (const std::bad_alloc&) {
        std::fputs("lamina: out of memory\n", stderr);  // needs no memory
        return 1;
    } catch (const std::exception& error) {
        return report(error.what(), 1);
    }
}

}  // namespace

int main(int argc, char** argv) {
    lamina::make_streams_safe();
    lamina::take_warnings(print_warning);
    lamina::set_command_line(argc, argv);
    try {
        const lamina::SignalStop signals;
        return lamina::with_large_stack([&] { return run_and_report(argc, argv, signals); });
    } catch (const std::system_error& error) {
        return report(error.what(), 1);
    }
}
