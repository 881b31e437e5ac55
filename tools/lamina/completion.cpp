// SPDX-License-Identifier: Apache-2.0
#include "completion.h"

#include <memory>

#include "base/error.h"
#include "base/process.h"
#include "base/text.h"
#include "verbs.h"

namespace lamina {
namespace {

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
