// SPDX-License-Identifier: Apache-2.0
#include "only_below_option.h"

#include <string>
#include <system_error>

#include "base/error.h"
#include "base/shortened.h"

namespace lamina {
namespace {

std::filesystem::path only_below;

}  // namespace

void add_only_below_option(CLI::App& verb) {
    verb.add_option_function<std::string>(
            "--only-below",
            [](const std::string& name) {
                std::error_code unreadable;
                if (!std::filesystem::is_directory(name, unreadable))
                    throw UsageError(
                        fmt::format("--only-below: found {}, expected a folder", shortened(name)));
                only_below = std::filesystem::canonical(name);
            },
            "Refuse every scene and data file that is not below this folder with all links "
            "followed, whoever names it: for files of people whom one does not know")
        ->option_text("FOLDER");
}

const std::filesystem::path& only_below_folder() {
    return only_below;
}

}  // namespace lamina
