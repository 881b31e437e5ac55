// SPDX-License-Identifier: Apache-2.0
#include "lamina/study.h"

#include <algorithm>
#include <utility>

#include "base/client.h"
#include "base/error.h"
#include "base/json_text.h"
#include "study/study_frames.h"
#include "study/study_output.h"
#include "study/study_runner.h"

namespace lamina {
namespace {

nlohmann::ordered_json begin_record() {
    nlohmann::ordered_json begin = study::describe_machine();
    begin["version"] = LAMINA_VERSION;
    begin["command"] = "lamina::run_study";
    return {{"begin", begin}};
}

// Throws Error if the folder has files that no study wrote, another study, or this study with
// changed data; or, unless `resume`, results of this study.
void check_folder(const study::StudyFolder& folder, study::RunList& list, bool resume) {
    folder.own().expect_own(study::StudyFolder::names());
    if (!std::filesystem::exists(folder.run_list())) return;
    const study::RunList there =
        study::run_list_from(load_json(folder.run_list()), folder.run_list());
    if (there.id() != list.id() || !resume) {
        fail("{}: holds {} study, expected an empty folder{}", folder.path.string(),
             there.id() == list.id() ? "this" : "another",
             there.id() == list.id() ? ", or resume" : "");
    }
    study::match_data(list, "now", there, folder.run_list().string());
}

StudyOutcome run(const std::filesystem::path& path, const study::StudyFolder& folder, bool resume) {
    const study::StudyFile file = study::load_study(path);
    study::RunList list = study::list_runs(file);
    const std::vector<study::StudyData> data = study::check_runs(list, file);
    study::DataStore store;
    study::list_data(data, store, list);
    check_folder(folder, list, resume);
    folder.make();
    study::write_run_list(folder, list);
    StudyOutcome outcome;
    study::StudyRunner runner(list, file, folder, {}, begin_record(), std::move(store),
                              [&](const std::string& text) { outcome.messages.push_back(text); });
    runner.run();
    study::StudySummary summary = study::write_study_output(folder);
    outcome.runs = summary.runs;
    outcome.findings = std::move(summary.findings);
    outcome.failures = std::move(summary.failures);
    return outcome;
}

}  // namespace

StudyOutcome run_study(const std::filesystem::path& study, const std::filesystem::path& folder,
                       bool resume, std::stop_token stop, const ProgressCallback& progress) {
    std::vector<std::string> warnings;
    // Several runs over one data set give equal warnings, which are kept once.
    const WarningTaker taker = [&](const std::string& text) {
        if (std::ranges::find(warnings, text) == warnings.end()) warnings.push_back(text);
    };
    ProgressListener listener{progress};
    const ClientScope scope({std::move(stop), &taker, &listener});
    StudyOutcome outcome = run(study, study::StudyFolder(folder), resume);
    outcome.messages.insert(outcome.messages.end(), warnings.begin(), warnings.end());
    return outcome;
}

}  // namespace lamina
