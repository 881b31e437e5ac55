// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <map>
#include <optional>
#include <string>

#include "lamina/settings.h"
#include "window.h"

namespace {

using lamina::ContextChoice;

int report(const std::string& message, int exit_code) {
    fmt::print(stderr, "lamina-view: {}\n", message);
    return exit_code;
}

// Returns the size in a text like "800x600", or nothing if it has another form.
std::optional<glm::ivec2> size_of(const std::string& text) {
    int width = 0, height = 0;
    char cross = 0, more = 0;
    if (std::sscanf(text.c_str(), "%d%c%d%c", &width, &cross, &height, &more) != 3 || cross != 'x')
        return {};
    constexpr int largest = 16384;
    if (width < 1 || height < 1 || width > largest || height > largest) return {};
    return glm::ivec2(width, height);
}

int run(int argc, char** argv) {
    lamina::view::WindowOptions options;
    CLI::App app("lamina-view: look at a scene or a data file, and see the error of each picture",
                 "lamina-view");
    app.set_version_flag("--version", "lamina-view " LAMINA_VERSION);
    app.add_option("FILE", options.file, "Scene (JSON), volume or mesh");
    std::string size;
    app.add_option("--size", size, "Of the picture in pixels, whatever the window's")
        ->option_text("WxH");
    app.add_option("--script", options.script, "Play this script (docs/viewer.md) and end")
        ->option_text("FILE");
    const std::map<std::string, lamina::Auto<ContextChoice>> contexts = {
        {"auto", lamina::automatic},
        {"osmesa", ContextChoice::osmesa},
        {"egl", ContextChoice::egl},
        {"cpu", ContextChoice::cpu}};
    std::string context = "auto";
    app.add_option("--context", context, "What draws: auto, osmesa, egl or cpu")
        ->check(CLI::IsMember(contexts))
        ->option_text("NAME");
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& success) {  // --help, --version
        return app.exit(success);
    } catch (const CLI::ParseError& error) {
        return report(error.what() + std::string(" (lamina-view --help shows the usage)"), 2);
    }
    if (!size.empty() && !(options.picture_size = size_of(size)))
        return report(fmt::format("--size: found {}, expected WIDTHxHEIGHT, each 1 to 16384", size),
                      2);
    options.session.context = contexts.at(context);
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
