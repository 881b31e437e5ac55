// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <new>

#include "base/error.h"
#include "base/interrupt.h"
#include "verbs.h"

namespace {

int report(const std::string& message, int exit_code) {
    fmt::print(stderr, "lamina: {}\n", lamina::one_line(message));
    return exit_code;
}

int run(int argc, char** argv) {
    int exit_code = 0;
    CLI::App app("lamina: volume rendering by slicing, with the error of each picture", "lamina");
    app.set_version_flag("--version", "lamina " LAMINA_VERSION);
    app.require_subcommand(1);
    lamina::add_verbs(app, exit_code);
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& success) {  // --help, --version
        return app.exit(success);
    } catch (const CLI::ParseError& error) {
        return report(std::string(error.what()) + " (lamina --help shows the usage)", 2);
    }
    return exit_code;
}

}  // namespace

int main(int argc, char** argv) {
    lamina::catch_interrupts();
    try {
        return run(argc, argv);
    } catch (const lamina::UsageError& error) {
        return report(error.what(), 2);
    } catch (const lamina::Interrupted&) {
        return report("interrupted, nothing written", 130);
    } catch (const std::bad_alloc&) {
        return report("out of memory", 1);
    } catch (const std::exception& error) {
        return report(error.what(), 1);
    }
}
