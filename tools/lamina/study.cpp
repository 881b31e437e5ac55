// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <charconv>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/client.h"
#include "base/error.h"
#include "base/process.h"
#include "git_commit.h"
#include "output_files.h"
#include "program.h"
#include "render/draw_context.h"
#include "scene_files/keys.h"
#include "shared_options.h"
#include "study/study_frames.h"
#include "study/study_output.h"
#include "study/study_runner.h"
#include "verbs.h"

namespace lamina {
namespace {

struct StudyOptions {
    std::string study, output;
    std::optional<std::string> shard;
    std::vector<std::string> merged;
    bool resume = false, yes = false, force = false, quiet = false;
};

study::Shard read_shard(const std::string& text) {
    study::Shard shard;
    const char* const end = text.data() + text.size();
    const auto number = std::from_chars(text.data(), end, shard.number);
    const bool slash = number.ec == std::errc() && number.ptr != end && *number.ptr == '/';
    const auto count = slash ? std::from_chars(number.ptr + 1, end, shard.count) : number;
    if (!slash || count.ec != std::errc() || count.ptr != end || shard.number < 1 ||
        shard.count < shard.number)
        throw UsageError(fmt::format("--shard {}: expected I/N with 1 <= I <= N, as in 2/8", text));
    return shard;
}

void check_count(const study::StudyFile& file, const StudyOptions& options) {
    const std::uint64_t count = study::run_count(file);
    if (count > study::most_runs_unasked && !options.yes) {
        fail("{}: sweep: found {} runs, expected at most {}, or {} with --yes", options.study,
             count, study::most_runs_unasked, study::most_runs);
    }
}

std::vector<std::filesystem::path> files_read(const std::vector<study::StudyData>& data,
                                              const StudyOptions& options) {
    std::vector<std::filesystem::path> read{options.study};
    for (const study::StudyData& each : data) {
        const auto files = files_of(each.drawn);
        read.insert(read.end(), files.begin(), files.end());
    }
    return read;
}

// Returns the run list in the folder, or nothing if there is none. Throws Error if it is another
// study's, or, unless `resume`, if this shard has records in it. `begun`: it has.
std::optional<study::RunList> check_folder(const study::RunList& list,
                                           const study::StudyFolder& folder, bool begun,
                                           bool resume) {
    if (!std::filesystem::exists(folder.run_list())) return std::nullopt;
    study::RunList there = study::run_list_from(load_json(folder.run_list()), folder.run_list());
    if (there.id() != list.id()) {
        fail("{}: holds another study, \"{}\": expected an empty folder, or one of this study",
             folder.path.string(), there.title);
    }
    if (begun && !resume) {
        fail("{}: holds finished runs of this study: --resume goes on with them",
             folder.path.string());
    }
    return there;
}

void say(const StudyOptions& options, const std::string& text) {
    if (!options.quiet) print_message("lamina: {}\n", text);
}

void say_what_is_left_out(const study::RunList& list, const StudyOptions& options) {
    for (const study::RunList::Dropped& dropped : list.dropped)
        say(options, fmt::format("{} runs left out: {}", dropped.runs, dropped.because));
}

void say_what_it_makes(const study::RunList& list, const StudyOptions& options) {
    say(options,
        fmt::format("{}: {} runs of {} scenes, each timed in {} rounds of {} frames", options.study,
                    list.runs.size(), list.scenes.size(), list.rounds, 2 * list.frames));
}

void write_results(const study::StudyFolder& folder, const StudyOptions& options) {
    const study::StudySummary summary = study::write_study_output(folder);
    for (const std::string& finding : summary.findings) print_result("{}\n", printable(finding));
    for (const std::string& failure : summary.failures) say(options, failure);
    say(options,
        fmt::format("wrote results.csv, results.json and report.html into {} ({} of {} "
                    "runs, {} of them failed)",
                    folder.path.string(), summary.runs, summary.wanted, summary.failures.size()));
}

nlohmann::ordered_json begin_record() {
    nlohmann::ordered_json begin = study::describe_machine();
    begin["version"] = LAMINA_VERSION;
    begin["commit"] = git_commit;
    begin["command"] = command_line();
    return {{"begin", begin}};
}

void run_study(const StudyOptions& options) {
    const study::Shard shard = options.shard ? read_shard(*options.shard) : study::Shard{};
    const study::StudyFile file = study::load_study(options.study);
    check_count(file, options);
    study::RunList list = study::list_runs(file);
    const std::vector<study::StudyData> data = study::check_runs(list, file);
    restrict_instructions_as_asked();
    const study::StudyFolder folder(options.output);
    const std::vector<std::filesystem::path> read = files_read(data, options);
    expect_different_files(read, folder.kept());
    const auto journal = folder.journal(shard.number, shard.count);
    const auto there = check_folder(list, folder, std::filesystem::exists(journal), options.resume);
    expect_own_folder(folder.path, "study", study::StudyFolder::names(), read, options.force);
    study::DataStore store;
    study::list_data(data, store, list);
    if (there) study::match_data(list, "now", *there, folder.run_list().string());
    folder.make();
    study::write_run_list(folder, list);
    say_what_it_makes(list, options);
    say_what_is_left_out(list, options);
    study::StudyRunner runner(list, file, folder, shard, begin_record(), std::move(store),
                              [&](const std::string& text) { say(options, text); });
    const std::size_t before = runner.finished();
    say(options, fmt::format("{} runs, {} of them finished before", runner.wanted(), before));
    try {
        runner.run();
        write_results(folder, options);
    } catch (const Interrupted&) {
        throw Interrupted(
            fmt::format("interrupted: {} of {} runs are finished and kept; --resume "
                        "goes on",
                        runner.finished(), runner.wanted()));
    }
}

void merge(const StudyOptions& options) {
    const study::StudyFolder folder(options.output);
    try {
        expect_own_folder(folder.path, "study", study::StudyFolder::names(), {}, options.force);
        study::merge_studies({options.merged.begin(), options.merged.end()}, folder,
                             [&](const std::string& text) { say(options, text); });
        write_results(folder, options);
    } catch (const Interrupted&) {
        throw Interrupted(fmt::format(
            "interrupted: {} may hold a part of it; the same command again makes it whole",
            folder.path.string()));
    }
}

}  // namespace

void add_study(CLI::App& app, int&) {
    const auto options = std::make_shared<StudyOptions>();
    CLI::App* const verb = app.add_subcommand(
        "study", "Measure error and run time of many settings of some scenes, and report");
    verb->add_option("STUDY", options->study, "Study file (JSON): scenes and what to sweep");
    verb->add_option("-o,--output", options->output, "Folder to write (made if need be)")
        ->type_name("FOLDER")
        ->required();
    verb->add_option("--shard", options->shard,
                     "Only the I-th of N parts of the runs, for job arrays")
        ->type_name("I/N");
    verb->add_flag("--resume", options->resume, "Go on with a study that was stopped");
    verb->add_option("--merge", options->merged,
                     "Put the shards in these folders together in the folder of -o")
        ->type_name("FOLDER");
    verb->add_flag("--yes", options->yes,
                   fmt::format("Run it though it has more than {} runs", study::most_runs_unasked));
    add_memory_option(*verb);
    verb->add_flag("--force", options->force, force_help);
    verb->add_flag("--quiet", options->quiet, "No messages and no progress on stderr");
    verb->callback([options] {
        Progress::set_quiet(options->quiet);
        if (!options->merged.empty()) {
            if (!options->study.empty() || options->shard || options->resume)
                throw UsageError("study --merge: expected the folders of shards and -o alone");
            return merge(*options);
        }
        if (options->study.empty())
            throw UsageError("study: expected a STUDY file, or --merge DIR");
        run_study(*options);
    });
}

}  // namespace lamina
