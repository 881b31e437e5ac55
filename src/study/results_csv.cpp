// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "base/arithmetic.h"
#include "study/study_results.h"
#include "study/text_file.h"

namespace lamina::study {
namespace {

const std::vector<std::string> channel_names{"R", "G", "B", "A"};

// All digits are written, so that the members of a front can be checked.
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
    for (const std::string& channel : channel_names) {
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
        for (const std::string& channel : channel_names)
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

std::string csv_of(const StudyResults& results) {
    const std::vector<std::string> columns = columns_of(results.list);
    CsvTable table(columns);
    for (const RunResult& result : results.runs)
        table.add_row(cells_of(results.list, result, columns.size()));
    return table.text();
}

}  // namespace lamina::study
