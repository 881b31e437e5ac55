// SPDX-License-Identifier: Apache-2.0
#include "study/tree_plots.h"

#include <algorithm>

#include "base/arithmetic.h"

namespace lamina::study {
namespace {

using Json = nlohmann::ordered_json;

struct TreePoint {
    double height = 0, irregularity = 1, error = 0, ms = 0;
    std::string id;
};
using Series = std::map<std::string, std::vector<TreePoint>>;

Json plot(const Series& series, const char* title, const char* x_label, bool x_log,
          const char* y_label, double TreePoint::*x, double TreePoint::*y) {
    Json json{{"title", title},
              {"x", {{"label", x_label}, {"log", x_log}}},
              {"y", {{"label", y_label}, {"log", true}}},
              {"series", Json::array()}};
    for (const auto& [name, points] : series) {
        Json list = Json::array();
        for (const TreePoint& point : points) list.push_back({point.*x, point.*y, point.id});
        json["series"].push_back({{"name", name}, {"points", list}});
    }
    return json;
}

}  // namespace

std::vector<int> factors_of(const RunList& list, const RunResult& result) {
    const nlohmann::json* const found = find_setting(list.runs[result.run].settings, factors_key);
    if (found == nullptr || !found->is_array() || !result.failed.empty()) return {};
    return found->get<std::vector<int>>();
}

std::string name_without_factors(const StudyRun& run) {
    Settings others = run.settings;
    std::erase_if(others, [](const auto& setting) { return setting.first == factors_key; });
    return run_name(others);
}

double irregularity(const std::vector<int>& factors) {
    const auto [least, most] = std::minmax_element(factors.begin(), factors.end());
    return static_cast<double>(*most) / *least;
}

nlohmann::ordered_json tree_plots(const RunList& list, const std::vector<const RunResult*>& runs) {
    Series series;
    for (const RunResult* const run : runs) {
        const std::vector<int> factors = factors_of(list, *run);
        if (factors.empty()) continue;
        series[name_without_factors(list.runs[run->run])].push_back(
            {static_cast<double>(factors.size()), irregularity(factors), run->all.l2,
             median(run->frame_ms), list.runs[run->run].id});
    }
    if (series.empty()) return Json::array();
    constexpr const char* height = "levels of the tree";
    constexpr const char* shape = "largest factor / smallest (1: regular)";
    constexpr const char* error = "L2 error (1/255)";
    constexpr const char* ms = "ms a frame";
    return {plot(series, "Error over the height of the tree", height, false, error,
                 &TreePoint::height, &TreePoint::error),
            plot(series, "Time over the height of the tree", height, false, ms, &TreePoint::height,
                 &TreePoint::ms),
            plot(series, "Error over the irregularity of the tree", shape, true, error,
                 &TreePoint::irregularity, &TreePoint::error),
            plot(series, "Time over the irregularity of the tree", shape, true, ms,
                 &TreePoint::irregularity, &TreePoint::ms)};
}

}  // namespace lamina::study
