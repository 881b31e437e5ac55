// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/client.h"
#include "base/json_text.h"
#include "base/output_file.h"
#include "base/process.h"
#include "git_commit.h"
#include "output_files.h"
#include "render/draw_context.h"
#include "selftest/selftest.h"
#include "selftest/shader_probe.h"
#include "shared_options.h"
#include "study/study_frames.h"
#include "verbs.h"

namespace lamina {
namespace {

constexpr int bound_exceeded = 3;
constexpr const char* selftest_name = "selftest";
constexpr const char *report_name = "selftest.json", *table_name = "selftest.txt",
                     *probe_name = "probe.json";

struct SelftestOptions {
    std::vector<std::string> groups;
    std::string output, context = "auto", probe;
    bool force = false, quiet = false;
};

// Returns the document of a report, with what drew on which machine.
nlohmann::ordered_json document_of(const Capabilities& capabilities,
                                   const nlohmann::ordered_json& results) {
    nlohmann::ordered_json document{{"version", LAMINA_VERSION},
                                    {"commit", git_commit},
                                    {"context", renderer_and_threads(capabilities)},
                                    {"machine", study::describe_machine()}};
    document.update(results);
    return document;
}

int run_probe(const SelftestOptions& options) {
    if (!options.groups.empty()) throw UsageError("--probe and --group: expected one of them");
    const auto [width, height] = pixels_of("--probe", options.probe);
    const DrawContext context(context_choice(options.context));
    if (context.capabilities().cpu)
        throw UsageError(
            "--probe: the cpu engine has no shaders, expected --context egl or osmesa");
    const std::filesystem::path folder = options.output;
    expect_own_folder(folder, selftest_name, {probe_name}, {}, options.force);
    make_folder(folder);
    AtomicFile file(folder / probe_name);
    const auto current = context.make_current();
    const nlohmann::ordered_json probe = selftest::probe_json(width, height);
    OwnFiles(folder, selftest_name).add({probe_name});
    file.write(json_text(document_of(context.capabilities(), probe), 1) + "\n");
    file.commit();
    print_result("{}{}\n", selftest::probe_table(probe),
                 renderer_and_threads(context.capabilities()));
    return 0;
}

int run(const SelftestOptions& options) {
    if (!options.probe.empty()) return run_probe(options);
    const std::vector<selftest::SelftestCase> cases = selftest::selftest_cases(options.groups);
    const Auto<ContextChoice> choice = context_choice(options.context);
    restrict_instructions_as_asked();
    const std::filesystem::path folder = options.output;
    expect_own_folder(folder, selftest_name, {report_name, table_name}, {}, options.force);
    make_folder(folder);
    AtomicFile report(folder / report_name), table_file(folder / table_name);
    const DrawContext context(choice);
    const auto current = context.make_current();
    const selftest::PictureMaker maker(context.capabilities());
    const std::vector<selftest::SelftestResult> results = selftest::run_selftest(cases, maker);

    OwnFiles(folder, selftest_name).add({report_name, table_name});
    report.write(
        json_text(document_of(context.capabilities(), selftest::selftest_json(results)), 1) + "\n");
    report.commit();
    const std::string table = selftest::selftest_table(results);
    table_file.write(table);
    table_file.commit();

    if (!options.quiet) write_result(table + "\n");
    print_result("{}\n{}: {} of {} cases passed\n", selftest::selftest_summary(results),
                 renderer_and_threads(context.capabilities()),
                 count_of(results, selftest::Verdict::passed), results.size());
    return count_of(results, selftest::Verdict::passed) == results.size() ? 0 : bound_exceeded;
}

}  // namespace

void add_selftest(CLI::App& app, int& exit_code) {
    const auto options = std::make_shared<SelftestOptions>();
    CLI::App* const verb = app.add_subcommand(
        selftest_name,
        "Draw stiff and extreme scenes, and say whether every picture keeps its bound");
    verb->add_option("-o,--output", options->output,
                     "Folder for selftest.json and selftest.txt (made if need be)")
        ->type_name("FOLDER")
        ->required();
    verb->add_option("--group", options->groups,
                     fmt::format("Only this group (may be repeated): {}",
                                 fmt::join(selftest::selftest_groups(), ", ")))
        ->type_name("GROUP")
        ->allow_extra_args(false);
    verb->add_option("--context", options->context,
                     "What draws: auto (a GPU, else cpu), osmesa, egl, cpu")
        ->option_text("auto|osmesa|egl|cpu");
    verb->add_option(
            "--probe", options->probe,
            "Draw no scenes, but time one kernel as a fragment and as a compute shader for "
            "so many pixels, and write probe.json")
        ->option_text("WxH");
    verb->add_flag("--force", options->force, force_help);
    verb->add_flag("--quiet", options->quiet, "The summary alone, and no progress on stderr");
    verb->callback([options, &exit_code] {
        Progress::set_quiet(options->quiet);
        exit_code = run(*options);
    });
}

}  // namespace lamina
