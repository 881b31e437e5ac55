// SPDX-License-Identifier: Apache-2.0
#include "study/study_results.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <numeric>
#include <set>
#include <sstream>

#include "base/arithmetic.h"
#include "base/error.h"
#include "base/input_file.h"
#include "base/json_text.h"
#include "scene_files/keys.h"
#include "study/report_files.h"

namespace lamina::study {
namespace {

struct CompleteLines {
    std::vector<nlohmann::json> records;
    std::int64_t bytes = 0;
};

// Returns the record in the line, or null if the line is not JSON.
nlohmann::json record_of(const std::string& line) {
    try {
        return parse_json(line);
    } catch (const Error&) {
        return nullptr;
    }
}

CompleteLines read_lines(const std::filesystem::path& path) {
    std::istringstream stream(read_file_bytes(path));
    CompleteLines lines;
    std::string line;
    // getline() sets eof if the newline is missing: that line was not written to its end.
    while (std::getline(stream, line) && !stream.eof()) {
        lines.records.push_back(record_of(line));
        if (!lines.records.back().is_object()) {
            fail("{}: line {}: found \"{}\", expected a record that lamina study wrote",
                 path.string(), lines.records.size(), one_line(shortened(line)));
        }
        lines.bytes += static_cast<std::int64_t>(line.size()) + 1;
    }
    return lines;
}

using Json = nlohmann::ordered_json;
using Records = std::vector<nlohmann::json>;

constexpr const char* channel_names[] = {"R", "G", "B", "A"};

// The records of one run in one journal.
struct RunRecords {
    const nlohmann::json* drawn = nullptr;
    std::map<int, const nlohmann::json*> rounds;  // first record of each round
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

// Returns the run's frame time over the baseline's. Only rounds of one session are compared: they
// were neighbours in time, on one machine.
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
    for (const char* const channel : channel_names)
        result.channels[channel] = norms_from(drawn.at("channels").at(channel));
    drawn.at("stages").get_to(result.stages_ms);
    drawn.at("bytes_gpu").get_to(result.bytes_gpu);
    drawn.at("bytes_host").get_to(result.bytes_host);
    drawn.at("renderer").get_to(result.renderer);
    return result;
}

// Adds the result of the first journal that is complete for this run or, if there is none, the
// message of the last failure.
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
        if (!found->second.failed.empty()) failed.failed = found->second.failed;
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

// Returns the environments of all journals, since processes may have run on several machines.
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

// Returns the number with all digits, so that a reader can check the Pareto front.
std::string number(double value) {
    return fmt::format("{}", value);
}

std::vector<std::string> columns_of(const RunList& list) {
    std::vector<std::string> columns{"scene"};
    columns.insert(columns.end(), list.swept.begin(), list.swept.end());
    for (const char* const name :
         {"frame_ms_median", "frame_ms_min", "frame_ms_max", "still_ms_median", "still_ms_min",
          "still_ms_max", "first_ms", "ratio", "linf", "l1", "l2"})
        columns.emplace_back(name);
    for (const char* const channel : channel_names) {
        for (const char* const norm : {"linf", "l1", "l2"})
            columns.push_back(fmt::format("{}_{}", norm, channel));
    }
    for (const char* const name : {"reference_error", "near_reference", "bytes", "bytes_gpu",
                                   "bytes_host", "pareto", "renderer", "run", "name", "failed"})
        columns.emplace_back(name);
    return columns;
}

void add_times(const std::vector<double>& times, std::vector<std::string>& cells) {
    const auto [least, most] = std::minmax_element(times.begin(), times.end());
    for (const double value : {median(times), *least, *most}) cells.push_back(number(value));
}

void add_norms(const ErrorNorms& norms, std::vector<std::string>& cells) {
    for (const double value : {norms.linf, norms.mean, norms.l2}) cells.push_back(number(value));
}

std::vector<std::string> cells_of(const RunList& list, const RunResult& result,
                                  std::size_t columns) {
    const StudyRun& run = list.runs[result.run];
    std::vector<std::string> cells{list.scenes[run.scene]};
    for (const std::string& key : list.swept) {
        const nlohmann::json* const value = find_setting(run.settings, key);
        cells.push_back(value == nullptr ? "" : setting_text(*value));
    }
    if (result.failed.empty()) {
        add_times(result.frame_ms, cells);
        add_times(result.still_ms, cells);
        cells.push_back(result.first_ms ? number(*result.first_ms) : "");
        cells.push_back(result.ratio ? number(*result.ratio) : "");
        add_norms(result.all, cells);
        for (const char* const channel : channel_names)
            add_norms(result.channels.at(channel), cells);
        cells.push_back(number(result.reference_error));
        cells.emplace_back(result.near_reference() ? "true" : "false");
        for (const std::int64_t bytes :
             {result.bytes_gpu + result.bytes_host, result.bytes_gpu, result.bytes_host})
            cells.push_back(fmt::format("{}", bytes));
        cells.emplace_back(result.pareto ? "true" : "false");
        cells.push_back(result.renderer);
    }
    cells.resize(columns - 3);
    cells.insert(cells.end(), {run.id, run.name, result.failed});
    return cells;
}

}  // namespace

std::vector<std::string> StudyFolder::names() {
    std::vector<std::string> all = results();
    for (const std::string& folder : folders()) all.push_back(folder);
    return all;
}

std::filesystem::path StudyFolder::journal(int shard, int shards) const {
    return path / fmt::format("journal-{}-of-{}.jsonl", shard, shards);
}

std::vector<std::filesystem::path> StudyFolder::journals() const {
    std::vector<std::filesystem::path> found;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(path, error)) {
        const std::string name = entry.path().filename().string();
        if (name.starts_with("journal-") && name.ends_with(".jsonl")) found.push_back(entry.path());
    }
    std::sort(found.begin(), found.end());
    return found;
}

std::vector<std::filesystem::path> StudyFolder::kept() const {
    std::vector<std::filesystem::path> found = journals();
    found.push_back(run_list());
    for (const std::string& folder : folders()) {
        std::error_code error;
        for (const auto& entry : std::filesystem::directory_iterator(path / folder, error))
            found.push_back(entry.path());
    }
    return found;
}

void StudyFolder::make() const {
    own().add(folders());
    for (const auto& folder : {path, references(), pictures()}) make_folder(folder);
}

std::string strange_record(const std::exception& error) {
    if (dynamic_cast<const Error*>(&error) != nullptr) return error.what();
    return "a record lacks a key, or a key has a value of another kind";
}

Journal::Journal(std::filesystem::path path) : path_(std::move(path)) {
    std::error_code ignored;
    if (std::filesystem::exists(path_, ignored)) expect_regular_file(path_);
    descriptor_ = open(path_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    if (descriptor_ < 0) fail("{}: cannot write: {}", path_.string(), std::strerror(errno));
    try {
        // Some file systems have no locks: there, nothing keeps two processes apart.
        if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
            fail("{}: another lamina study is writing it", path_.string());
        CompleteLines lines = read_lines(path_);
        if (ftruncate(descriptor_, lines.bytes) != 0)
            fail("{}: cannot write: {}", path_.string(), std::strerror(errno));
        found_ = std::move(lines.records);
    } catch (...) {
        close(descriptor_);
        throw;
    }
}

Journal::~Journal() {
    close(descriptor_);
}

void Journal::append(const nlohmann::ordered_json& record) {
    const std::string line = json_text(record) + "\n";
    std::size_t written = 0;
    while (written < line.size()) {
        const ssize_t count = write(descriptor_, line.data() + written, line.size() - written);
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) fail("{}: cannot write: {}", path_.string(), std::strerror(errno));
        written += static_cast<std::size_t>(count);
    }
    if (fdatasync(descriptor_) != 0)
        fail("{}: cannot write: {}", path_.string(), std::strerror(errno));
}

std::vector<nlohmann::json> Journal::read(const std::filesystem::path& path) {
    return read_lines(path).records;
}

std::vector<bool> pareto_front(const std::vector<CostAndError>& points) {
    std::vector<std::size_t> order(points.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        if (points[a].cost != points[b].cost) return points[a].cost < points[b].cost;
        return points[a].error < points[b].error;
    });
    std::vector<bool> front(points.size(), false);
    CostAndError last{-INFINITY, INFINITY};  // last point of the front so far
    for (const std::size_t i : order) {
        const CostAndError& point = points[i];
        const bool equal = point.cost == last.cost && point.error == last.error;
        if (!equal && point.error >= last.error) continue;
        front[i] = true;
        last = point;
    }
    return front;
}

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
    } catch (const std::exception& error) {
        fail("{}: a journal holds what lamina study did not write: {}", folder.path.string(),
             strange_record(error));
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

std::string csv_of(const StudyResults& results) {
    const std::vector<std::string> columns = columns_of(results.list);
    CsvTable table(columns);
    for (const RunResult& result : results.runs)
        table.add_row(cells_of(results.list, result, columns.size()));
    return table.text();
}

}  // namespace lamina::study
