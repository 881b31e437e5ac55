// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <memory>

#include "base/error.h"
#include "base/process.h"
#include "base/text.h"
#include "manual_page.h"
#include "markdown_page.h"
#include "scene_files/scene_keys.h"
#include "verbs.h"

namespace lamina {
namespace {

const CommandDescription& find(const CommandDescription& program, const std::string& verb) {
    if (verb.empty()) return program;
    const auto found = std::find_if(
        program.verbs.begin(), program.verbs.end(),
        [&](const CommandDescription& v) { return v.name == program.name + " " + verb; });
    if (found == program.verbs.end())
        throw UsageError(
            fmt::format("man {}: unknown verb (lamina --help lists them)", shortened(verb)));
    return *found;
}

}  // namespace

void add_man(CLI::App& app, int&) {
    struct Options {
        std::string name;
        bool markdown = false, schema = false;
    };
    const auto options = std::make_shared<Options>();
    CLI::App* const verb =
        app.add_subcommand("man", "Print the manual page of the program, or of a verb");
    verb->add_option("VERB", options->name, "The verb; without one the page of lamina itself");
    verb->add_flag("--markdown", options->markdown, "Print all verbs as one page of Markdown");
    verb->add_flag("--scene-schema", options->schema,
                   "Print the JSON schema of scene files, for editors");
    verb->footer("To read it: lamina man render | man -l -");
    verb->callback([&app, options] {
        if (options->markdown && !options->name.empty())
            throw UsageError("man --markdown: has all verbs, expected no VERB beside it");
        if (options->schema && (options->markdown || !options->name.empty()))
            throw UsageError("man --scene-schema: is no page, expected nothing beside it");
        if (options->schema) return write_result(scene_schema_text());
        write_result(options->markdown ? markdown_page(describe(app))
                                       : manual_page(find(describe(app), options->name),
                                                     "lamina " LAMINA_VERSION));
    });
}

}  // namespace lamina
