// SPDX-License-Identifier: Apache-2.0
#include "study/study_findings.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/arithmetic.h"
#include "study/tree_advice.h"

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

// The runs of one scene that did not fail.
Runs runs_of(const StudyResults& results, std::size_t scene) {
    Runs runs;
    for (const RunResult& result : results.runs) {
        if (results.list.runs[result.run].scene == scene && result.failed.empty())
            runs.push_back(&result);
    }
    return runs;
}

void tell_failed(const StudyResults& results, std::size_t scene,
                 std::vector<std::string>& findings) {
    const auto failed =
        std::count_if(results.runs.begin(), results.runs.end(), [&](const RunResult& result) {
            return results.list.runs[result.run].scene == scene && !result.failed.empty();
        });
    if (failed > 0)
        findings.push_back(fmt::format("{}: {} run{} failed.", results.list.scenes[scene], failed,
                                       failed == 1 ? "" : "s"));
}

}  // namespace

std::vector<std::string> study_findings(const StudyResults& results) {
    const RunList& list = results.list;
    std::vector<std::string> findings;
    // Which trees to take is the answer; how all runs compare comes after it.
    for (const bool in_floats : {false, true}) {
        for (std::size_t scene = 0; scene < list.scenes.size(); ++scene) {
            for (std::string& finding :
                 tree_findings(list, list.scenes[scene], runs_of(results, scene), in_floats))
                findings.push_back(std::move(finding));
        }
    }
    for (std::size_t scene = 0; scene < list.scenes.size(); ++scene) {
        const Runs runs = runs_of(results, scene);
        if (!runs.empty()) {
            tell_front(list, list.scenes[scene], runs, findings);
            tell_baseline(list, list.scenes[scene], runs, list.runs[list.baselines[scene]],
                          findings);
            tell_limits(list.scenes[scene], runs, findings);
        }
        tell_failed(results, scene, findings);
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
