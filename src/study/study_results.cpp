// SPDX-License-Identifier: Apache-2.0
#include "study/study_results.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "base/arithmetic.h"
#include "base/error.h"
#include "base/json_text.h"
#include "scene_files/json_reader.h"
#include "study/journal.h"
#include "study/pareto.h"

namespace lamina::study {
namespace {

using Json = nlohmann::ordered_json;
using Records = std::vector<nlohmann::json>;

// The records of one run in one journal.
struct RunRecords {
    const nlohmann::json* drawn = nullptr;
    std::map<int, const nlohmann::json*> rounds;  // the first record of each
    std::map<std::pair<int, int>, double> ms;     // medians by session and round
    std::string failed;
};
using JournalRecords = std::map<std::string, RunRecords>;  // by run id

JournalRecords by_run(const Records& records) {
    JournalRecords runs;
    for (const nlohmann::json& record : records) {
        if (!record.contains("run")) continue;
        RunRecords& run = runs[record["run"]];
        if (record.contains("drawn")) run.drawn = &record["drawn"];
        if (record.contains("failed")) run.failed = record["failed"];
        if (!record.contains("round")) continue;
        const int round = record["round"];
        const auto times = record.at("frame_ms").get<std::vector<double>>();
        if (times.empty() || record.at("still_ms").empty()) fail("a round without times");
        run.rounds.emplace(round, &record);
        run.ms.emplace(std::pair(record.value("session", 0), round), median(times));
    }
    return runs;
}

bool is_complete(const RunRecords& run, int rounds) {
    return run.drawn != nullptr && run.rounds.size() == static_cast<std::size_t>(rounds);
}

ErrorNorms norms_from(const nlohmann::json& json) {
    return {json.at("linf"), json.at("l1"), json.at("l2")};
}

// Only rounds of one session are compared: they were neighbours in time, on one machine.
std::optional<double> ratio_to(const RunRecords& run, const RunRecords& baseline) {
    std::vector<double> ratios;
    for (const auto& [place, ms] : run.ms) {
        const auto found = baseline.ms.find(place);
        if (found != baseline.ms.end()) ratios.push_back(ms / found->second);
    }
    if (ratios.empty()) return std::nullopt;
    return median(ratios);
}

RunResult result_of(std::size_t number, const RunRecords& run) {
    RunResult result;
    result.run = number;
    for (const auto& [round, record] : run.rounds) {
        const auto add = [&](const char* key, std::vector<double>& all) {
            const auto times = record->at(key).get<std::vector<double>>();
            all.insert(all.end(), times.begin(), times.end());
        };
        add("frame_ms", result.frame_ms);
        add("still_ms", result.still_ms);
    }
    const nlohmann::json& drawn = *run.drawn;
    result.reference = drawn.at("reference");
    if (drawn.contains("first_ms")) result.first_ms = drawn["first_ms"].get<double>();
    result.all = norms_from(drawn.at("all"));
    for (const char* const channel : {"R", "G", "B", "A"})
        result.channels[channel] = norms_from(drawn.at("channels").at(channel));
    drawn.at("stages").get_to(result.stages_ms);
    drawn.at("bytes_gpu").get_to(result.bytes_gpu);
    drawn.at("bytes_host").get_to(result.bytes_host);
    drawn.at("renderer").get_to(result.renderer);
    return result;
}

// Adds the result of the first journal that has all of a run or, where there is none, the message
// of its failure.
void add_result(const RunList& list, std::size_t number,
                const std::vector<JournalRecords>& journals, std::vector<RunResult>& results) {
    const StudyRun& run = list.runs[number];
    RunResult failed;
    for (const JournalRecords& journal : journals) {
        const auto found = journal.find(run.id);
        if (found == journal.end()) continue;
        if (is_complete(found->second, list.rounds)) {
            results.push_back(result_of(number, found->second));
            const auto baseline = journal.find(list.runs[list.baselines[run.scene]].id);
            if (baseline != journal.end())
                results.back().ratio = ratio_to(found->second, baseline->second);
            return;
        }
        failed.failed = found->second.failed;
    }
    if (failed.failed.empty()) return;
    failed.run = number;
    results.push_back(failed);
}

void find_fronts(StudyResults& results) {
    for (std::size_t scene = 0; scene < results.list.scenes.size(); ++scene) {
        std::vector<RunResult*> runs;
        std::vector<CostAndError> points;
        for (RunResult& result : results.runs) {
            if (!result.failed.empty() || results.list.runs[result.run].scene != scene) continue;
            runs.push_back(&result);
            points.push_back({median(result.frame_ms), result.all.l2});
        }
        const std::vector<bool> front = pareto_front(points);
        for (std::size_t i = 0; i < runs.size(); ++i) runs[i]->pareto = front[i];
    }
}

// The environments are those of all journals, because processes may have run on several machines.
Json environment_of(const std::vector<Records>& journals, const std::vector<RunResult>& runs) {
    std::map<std::string, std::set<std::string>> words;
    for (const Records& records : journals) {
        for (const nlohmann::json& record : records) {
            if (!record.contains("begin")) continue;
            for (const auto& [key, value] : record["begin"].items())
                words[key].insert(value.is_string() ? value.get<std::string>() : json_text(value));
        }
    }
    for (const RunResult& run : runs) {
        if (!run.renderer.empty()) words["drivers"].insert(run.renderer);
    }
    Json json;
    for (const char* const key :
         {"machine", "processors", "drivers", "version", "commit", "command", "date"})
        json[key] = fmt::format("{}", fmt::join(words[key], "; "));
    return json;
}

}  // namespace

StudyResults read_results(const StudyFolder& folder) {
    StudyResults results;
    results.list = run_list_from(load_json(folder.run_list()), folder.run_list());
    std::vector<Records> records;
    std::vector<JournalRecords> journals;
    for (const auto& path : folder.journals()) records.push_back(Journal::read(path));
    try {
        for (const Records& each : records) journals.push_back(by_run(each));
        for (std::size_t run = 0; run < results.list.runs.size(); ++run)
            add_result(results.list, run, journals, results.runs);
    } catch (const Error& error) {
        fail("{}: a journal holds what lamina study did not write: {}", folder.path.string(),
             error.what());
    } catch (const std::exception&) {
        fail("{}: a journal holds what lamina study did not write: {}", folder.path.string(),
             strange_record);
    }
    for (RunResult& run : results.runs) {
        if (run.failed.empty())
            run.reference_error =
                ReferenceStore::error_estimate(folder.references(), run.reference);
    }
    find_fronts(results);
    results.environment = environment_of(records, results.runs);
    return results;
}

}  // namespace lamina::study
