// SPDX-License-Identifier: Apache-2.0
#include "study/study_findings.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/median.h"
#include "study/tree_plots.h"

namespace lamina::study {
namespace {

using Runs = std::vector<const RunResult*>;

double ms_of(const RunResult& run) {
    return median(run.frame_ms);
}

std::string describe(const RunList& list, const RunResult& run) {
    return fmt::format("{} ({:.3g} ms, L2 {:.3g}, Linf {:.3g})", list.runs[run.run].name,
                       ms_of(run), run.all.l2, run.all.linf);
}

std::string times(double ratio) {
    return ratio >= 1 ? fmt::format("{:.2f} times the time", ratio)
                      : fmt::format("{:.2f} of the time", ratio);
}

void tell_front(const RunList& list, const std::string& scene, const Runs& runs,
                std::vector<std::string>& findings) {
    Runs front;
    std::copy_if(runs.begin(), runs.end(), std::back_inserter(front),
                 [](const RunResult* run) { return run->pareto; });
    std::sort(front.begin(), front.end(),
              [](const RunResult* a, const RunResult* b) { return ms_of(*a) < ms_of(*b); });
    const std::string ends =
        front.size() == 1
            ? fmt::format("{} is both the fastest and the most exact",
                          describe(list, *front.front()))
            : fmt::format("from the fastest, {}, to the most exact, {}",
                          describe(list, *front.front()), describe(list, *front.back()));
    findings.push_back(
        fmt::format("{}: {} of {} runs are on the Pareto front of time and L2 error: {}.", scene,
                    front.size(), runs.size(), ends));
}

void tell_baseline(const RunList& list, const std::string& scene, const Runs& runs,
                   const StudyRun& baseline, std::vector<std::string>& findings) {
    const auto is_baseline = [&](const RunResult* run) {
        return list.runs[run->run].id == baseline.id;
    };
    const auto found = std::find_if(runs.begin(), runs.end(), is_baseline);
    if (found == runs.end()) return;
    const RunResult& base = **found;
    const auto by_error = [](const RunResult* a, const RunResult* b) {
        return a->all.l2 < b->all.l2;
    };
    const RunResult& best = **std::min_element(runs.begin(), runs.end(), by_error);
    const RunResult& worst = **std::max_element(runs.begin(), runs.end(), by_error);
    std::string text = fmt::format("{}: the baseline is {}", scene, describe(list, base));
    for (const auto& [word, run] : {std::pair("least", &best), {"largest", &worst}}) {
        if (run == &base || !run->ratio) continue;
        text += fmt::format("; the {} L2 error has {}, in {}", word, describe(list, *run),
                            times(*run->ratio));
    }
    findings.push_back(text + ".");
}

void tell_trees(const RunList& list, const std::string& scene, const Runs& runs,
                std::vector<std::string>& findings) {
    std::map<std::size_t, Runs> by_height;
    for (const RunResult* const run : runs) {
        const std::size_t height = factors_of(list, *run).size();
        if (height > 0) by_height[height].push_back(run);
    }
    std::string text;
    for (auto& [height, trees] : by_height) {
        std::sort(trees.begin(), trees.end(),
                  [](const RunResult* a, const RunResult* b) { return a->all.l2 < b->all.l2; });
        text += fmt::format("{} {} level{}: L2 {:.3g} ({}) to {:.3g} ({})", text.empty() ? "" : ";",
                            height, height == 1 ? "" : "s", trees.front()->all.l2,
                            list.runs[trees.front()->run].name, trees.back()->all.l2,
                            list.runs[trees.back()->run].name);
    }
    if (!text.empty())
        findings.push_back(fmt::format("{}: trees by their height:{}.", scene, text));
}

void tell_limits(const std::string& scene, const Runs& runs, std::vector<std::string>& findings) {
    const auto near = std::count_if(runs.begin(), runs.end(),
                                    [](const RunResult* run) { return run->near_reference(); });
    if (near > 0) {
        findings.push_back(fmt::format(
            "{}: {} of {} runs have Linf errors below ten times the reference's own estimate: "
            "their errors are not told apart.",
            scene, near, runs.size()));
    }
}

}  // namespace

std::vector<std::string> study_findings(const StudyResults& results) {
    const RunList& list = results.list;
    std::vector<std::string> findings;
    for (std::size_t scene = 0; scene < list.scenes.size(); ++scene) {
        Runs runs;
        std::size_t failed = 0;
        for (const RunResult& result : results.runs) {
            if (list.runs[result.run].scene != scene) continue;
            if (result.failed.empty())
                runs.push_back(&result);
            else
                ++failed;
        }
        const std::string& name = list.scenes[scene];
        if (!runs.empty()) {
            tell_front(list, name, runs, findings);
            tell_baseline(list, name, runs, list.runs[list.baselines[scene]], findings);
            tell_trees(list, name, runs, findings);
            tell_limits(name, runs, findings);
        }
        if (failed > 0)
            findings.push_back(
                fmt::format("{}: {} run{} failed.", name, failed, failed == 1 ? "" : "s"));
    }
    if (results.environment.at("machine").get<std::string>().find("; ") != std::string::npos) {
        findings.emplace_back(
            "The runs are of several machines: their times can be compared as ratios only.");
    }
    if (results.runs.size() < list.runs.size()) {
        findings.push_back(
            fmt::format("{} of {} runs are finished.", results.runs.size(), list.runs.size()));
    }
    return findings;
}

}  // namespace lamina::study
