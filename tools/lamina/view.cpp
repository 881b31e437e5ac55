// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/process.h"
#include "verbs.h"

namespace lamina {
namespace {

constexpr const char* viewer_program = "lamina-view";

struct ViewVerbOptions {
    std::string file, script, size, context;
};

std::vector<std::string> arguments_of(const ViewVerbOptions& options) {
    std::vector<std::string> arguments = {viewer_program};
    const auto add = [&](const char* name, const std::string& value) {
        if (!value.empty()) arguments.insert(arguments.end(), {name, value});
    };
    add("--context", options.context);
    add("--script", options.script);
    add("--size", options.size);
    if (!options.file.empty()) arguments.insert(arguments.end(), {"--", options.file});
    return arguments;
}

// Replaces this process by the viewer, which then handles signals and sets the exit code.
[[noreturn]] void become_viewer(const ViewVerbOptions& options) {
    std::vector<std::string> arguments = arguments_of(options);
    std::vector<char*> pointers;
    for (std::string& argument : arguments) pointers.push_back(argument.data());
    pointers.push_back(nullptr);
    flush_results();
    if (const auto program = find_program(viewer_program))
        execv(program->c_str(), pointers.data());
    else
        errno = ENOENT;
    fail(
        "cannot start lamina-view ({}), which belongs beside lamina or in the PATH: it is built "
        "where "
        "libglfw3-dev and libimgui-dev are installed",
        std::strerror(errno));
}

}  // namespace

void add_view(CLI::App& app, int&) {
    const auto options = std::make_shared<ViewVerbOptions>();
    CLI::App* const verb = app.add_subcommand(
        "view", "Look at a scene or a data file in a window, and see the error of each picture");
    verb->footer("In short: lamina FILE");
    verb->add_option("FILE", options->file, "Scene (JSON), volume or mesh");
    verb->add_option("--size", options->size, "Of the picture in pixels, whatever the window's")
        ->option_text("WxH");
    verb->add_option("--context", options->context, "What draws: auto, osmesa, egl or cpu")
        ->option_text("NAME");
    verb->add_option("--script", options->script, "Play this script (docs/viewer.md) and end")
        ->option_text("FILE");
    verb->callback([options] { become_viewer(*options); });
}

}  // namespace lamina
