// SPDX-License-Identifier: Apache-2.0
#include "only_below_option.h"

#include <memory>
#include <optional>
#include <string>

#include "base/client.h"
#include "base/error.h"

namespace lamina {

void add_only_below_option(CLI::App& verb) {
    // The verb runs while its App is there, and the scope with it.
    const auto scope = std::make_shared<std::optional<OnlyBelowScope>>();
    verb.add_option_function<std::string>(
            "--only-below",
            [scope](const std::string& name) {
                if (name.empty()) throw UsageError("--only-below: found '', expected a folder");
                try {
                    scope->emplace(*allowed_folder(name, "--only-below"));
                } catch (const Error& error) {
                    throw UsageError(error.what());
                }
            },
            "Refuse every scene and data file that is not below this folder with all links "
            "followed, whoever names it: for files of people whom one does not know")
        ->option_text("FOLDER");
}

}  // namespace lamina
