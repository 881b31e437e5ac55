// SPDX-License-Identifier: Apache-2.0
#include "study/tree_advice.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "base/arithmetic.h"

namespace lamina::study {
namespace {

using Json = nlohmann::ordered_json;
using RunPointers = std::vector<const RunResult*>;

constexpr const char* target_key = "render.target";

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

// Returns the bifurcation factors of a run, from the root to the leaves; empty if no tree is swept
// or the run failed.
std::vector<int> factors_of(const RunList& list, const RunResult& result) {
    const nlohmann::json* const found = find_setting(list.runs[result.run].settings, factors_key);
    if (found == nullptr || !found->is_array() || !result.failed.empty()) return {};
    return found->get<std::vector<int>>();
}

// Returns a name of the run's settings without the factors: "fixed8".
std::string name_without_factors(const StudyRun& run) {
    Settings others = run.settings;
    std::erase_if(others, [](const auto& setting) { return setting.first == factors_key; });
    return run_name(others);
}

// Returns the largest factor over the smallest; 1 for a regular tree.
double irregularity(const std::vector<int>& factors) {
    const auto [least, most] = std::minmax_element(factors.begin(), factors.end());
    return static_cast<double>(*most) / *least;
}

bool drawn_in_floats(const RunList& list, const StudyRun& run) {
    for (const Settings* const settings : {&run.settings, &list.own[run.scene], &list.base}) {
        const nlohmann::json* const target = find_setting(*settings, target_key);
        if (target != nullptr && target->is_string())
            return target->get<std::string>().starts_with("float");
    }
    return true;  // the default is float32
}

std::string factors_text(const RunList& list, const RunResult& run) {
    return fmt::format("{}", fmt::join(factors_of(list, run), "x"));
}

std::string nodes_text(std::int64_t nodes) {
    return fmt::format("{} node{}", nodes, nodes == 1 ? "" : "s");
}

// Returns the smallest power of ten that is not below the number of nodes.
std::int64_t bracket_of(std::int64_t nodes) {
    std::int64_t most = 1;
    while (most < nodes) most *= 10;
    return most;
}

std::vector<TreeGroup::Choice> choices_among(const RunList& list, const RunPointers& trees) {
    std::map<std::int64_t, const RunResult*> best;
    for (const RunResult* const tree : trees) {
        const RunResult*& found = best[bracket_of(nodes_of(factors_of(list, *tree)))];
        if (found == nullptr || tree->all.l2 < found->all.l2) found = tree;
    }
    std::vector<TreeGroup::Choice> choices;
    for (const auto& [most, run] : best) choices.push_back({most, run});
    return choices;
}

std::string baseline_name(const RunList& list, std::size_t scene) {
    return list.runs[list.baselines[scene]].name;
}

// Returns the time of a run as text: relative to the baseline, if that was measured, too.
std::string cost_text(const RunList& list, const RunResult& run) {
    if (!run.ratio) return fmt::format("in {:.3g} ms", median(run.frame_ms));
    return fmt::format("in {:.2f} times the time of {}", *run.ratio,
                       baseline_name(list, list.runs[run.run].scene));
}

// Says how the error of a tree compares with that of the run without one, if there is one.
std::string gain_text(const RunResult& tree, const RunResult* straight) {
    if (straight == nullptr) return {};
    if (tree.near_reference() && straight->near_reference())
        return ", which the reference's own error does not tell from that without a tree";
    if (tree.all.l2 == 0) return fmt::format(", {:.3g} without a tree", straight->all.l2);
    if (straight->all.l2 <= tree.all.l2)
        return fmt::format(", but {:.3g} without a tree", straight->all.l2);
    return fmt::format(", {:.3g} times less than without a tree", straight->all.l2 / tree.all.l2);
}

std::string nodes_range(std::int64_t most) {
    if (most == 1) return "1";
    return fmt::format("{} to {}", most / 10 + 1, most);
}

// Rows of the tables. Trees in floats have a table of their own: beside codes their target alone
// would make them best.
struct AnswerRows {
    Json trees = Json::array(), trees_in_floats = Json::array(), straight = Json::array();
};

void add_measured(Json& row, const RunResult& run) {
    row["L2"] = run.all.l2;
    row["L∞"] = run.all.linf;
    row["ms a frame"] = median(run.frame_ms);
    row["× baseline"] = run.ratio ? Json(*run.ratio) : Json();
}

void add_answers(AnswerRows& rows, const RunList& list, const std::string& scene,
                 const RunPointers& runs) {
    for (const TreeGroup& group : tree_groups(list, runs)) {
        for (const TreeGroup::Choice& choice : group.choices) {
            const auto factors = factors_of(list, *choice.run);
            Json row{{"scene", scene},
                     {"drawn with", group.name},
                     {"nodes", nodes_range(choice.most_nodes)},
                     {"take", factors_text(list, *choice.run)},
                     {"its nodes", nodes_of(factors)}};
            add_measured(row, *choice.run);
            row["L2 without a tree / its L2"] =
                group.straight != nullptr && choice.run->all.l2 > 0
                    ? Json(group.straight->all.l2 / choice.run->all.l2)
                    : Json();
            (group.in_floats ? rows.trees_in_floats : rows.trees).push_back(row);
        }
    }
    for (const bool in_floats : {false, true}) {
        for (const RunResult* const run : runs) {
            if (!run->failed.empty() || !factors_of(list, *run).empty() ||
                drawn_in_floats(list, list.runs[run->run]) != in_floats)
                continue;
            Json row{{"scene", scene}, {"drawn with", list.runs[run->run].name}};
            add_measured(row, *run);
            rows.straight.push_back(row);
        }
    }
}

}  // namespace

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

std::int64_t nodes_of(const std::vector<int>& factors) {
    std::int64_t nodes = 0, of_level = 1;
    for (const int factor : factors) {
        nodes += of_level;
        of_level *= factor;
    }
    return nodes;
}

const RunResult& TreeGroup::best() const {
    return *std::min_element(choices.begin(), choices.end(), [](const Choice& a, const Choice& b) {
                return a.run->all.l2 < b.run->all.l2;
            })->run;
}

std::vector<TreeGroup> tree_groups(const RunList& list, const std::vector<const RunResult*>& runs) {
    std::map<std::pair<bool, std::string>, RunPointers> trees;
    std::map<std::string, const RunResult*> straight;
    for (const RunResult* const run : runs) {
        if (!run->failed.empty()) continue;
        const StudyRun& settings = list.runs[run->run];
        const std::string name = name_without_factors(settings);
        if (factors_of(list, *run).empty())
            straight[name] = run;
        else
            trees[{drawn_in_floats(list, settings), name}].push_back(run);
    }
    std::vector<TreeGroup> groups;
    for (const auto& [key, members] : trees) {
        const auto& [in_floats, name] = key;
        const auto without = straight.find(name);
        groups.push_back({name, in_floats, choices_among(list, members),
                          without == straight.end() ? nullptr : without->second});
    }
    return groups;
}

std::vector<std::string> tree_findings(const RunList& list, const std::string& scene,
                                       const std::vector<const RunResult*>& runs, bool in_floats) {
    std::vector<std::string> findings;
    for (const TreeGroup& group : tree_groups(list, runs)) {
        if (group.in_floats != in_floats) continue;
        const RunResult& best = group.best();
        findings.push_back(fmt::format("{}, {}: take the factors {} ({}): L2 {:.3g}{}, {}.", scene,
                                       group.name, factors_text(list, best),
                                       nodes_text(nodes_of(factors_of(list, best))), best.all.l2,
                                       gain_text(best, group.straight), cost_text(list, best)));
    }
    return findings;
}

nlohmann::ordered_json tree_answers(const StudyResults& results) {
    const RunList& list = results.list;
    AnswerRows rows;
    for (std::size_t scene = 0; scene < list.scenes.size(); ++scene) {
        RunPointers runs;
        for (const RunResult& result : results.runs) {
            if (list.runs[result.run].scene == scene) runs.push_back(&result);
        }
        add_answers(rows, list, list.scenes[scene], runs);
    }
    if (rows.trees.empty() && rows.trees_in_floats.empty()) return nullptr;
    Json tables = Json::array();
    const auto add = [&](const char* caption, const Json& table) {
        if (!table.empty()) tables.push_back({{"caption", caption}, {"rows", table}});
    };
    add("The tree of the smallest L2 at each number of nodes", rows.trees);
    add("The same in floats, whose error is not that of codes", rows.trees_in_floats);
    add("Without a tree, in codes and then in floats", rows.straight);
    return {{"title", "Which factors to take"},
            {"note",
             "Factors stand from the root to the leaves. A node is an image that others are "
             "composited into; each costs time and memory. Errors are in 1/255."},
            {"tables", tables}};
}

}  // namespace lamina::study
