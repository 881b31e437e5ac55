// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <map>
#include <string>

#include "lamina/context_choice.h"
#include "window.h"

namespace {

using lamina::ContextChoice;

int report(const std::string& message, int exit_code) {
    fmt::print(stderr, "lamina-view: {}\n", message);
    return exit_code;
}

int run(int argc, char** argv) {
    lamina::view::WindowOptions options;
    CLI::App app("lamina-view: look at a scene or a data file, and see the error of each picture",
                 "lamina-view");
    app.set_version_flag("--version", "lamina-view " LAMINA_VERSION);
    app.add_option("FILE", options.file, "Scene (JSON), volume or mesh");
    const std::map<std::string, ContextChoice> contexts = {{"auto", ContextChoice::automatic},
                                                           {"osmesa", ContextChoice::osmesa},
                                                           {"egl", ContextChoice::egl},
                                                           {"cpu", ContextChoice::cpu}};
    app.add_option("--context", options.session.context, "What draws: auto, osmesa, egl or cpu")
        ->transform(CLI::CheckedTransformer(contexts))
        ->option_text("NAME");
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& success) {  // --help, --version
        return app.exit(success);
    } catch (const CLI::ParseError& error) {
        return report(error.what() + std::string(" (lamina-view --help shows the usage)"), 2);
    }
    options.session.many_frames = true;
    lamina::view::Window(options).run();
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        return run(argc, argv);
    } catch (const std::exception& error) {
        return report(error.what(), 1);
    }
}
