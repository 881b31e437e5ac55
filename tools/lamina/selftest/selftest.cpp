// SPDX-License-Identifier: Apache-2.0
#include "selftest/selftest.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <map>

#include "base/client.h"
#include "base/enum_words.h"
#include "base/error.h"
#include "base/profile.h"
#include "selftest/case_makers.h"

namespace lamina::selftest {

const char* name_of(Verdict verdict) {
    return word_of(verdict, {"passed", "failed", "refused"});
}

const std::vector<std::string>& selftest_groups() {
    static const std::vector<std::string> groups{"optics",  "cells", "depth", "meshes",     "views",
                                                 "numbers", "clips", "light", "metamorphic"};
    return groups;
}

std::vector<SelftestCase> selftest_cases(const std::vector<std::string>& groups) {
    static const std::map<std::string, std::vector<SelftestCase> (*)()> makers{
        {"optics", optics_cases}, {"cells", cell_cases},  {"depth", depth_cases},
        {"meshes", mesh_cases},   {"views", view_cases},  {"numbers", number_cases},
        {"clips", clip_cases},    {"light", light_cases}, {"metamorphic", metamorphic_cases}};
    for (const std::string& each : groups) {
        if (!makers.contains(each))
            throw UsageError(fmt::format("--group: found \"{}\", expected one of {}", each,
                                         fmt::join(selftest_groups(), ", ")));
    }
    std::vector<SelftestCase> cases;
    for (const std::string& group : selftest_groups()) {
        if (!groups.empty() && std::ranges::find(groups, group) == groups.end()) continue;
        std::ranges::move(makers.at(group)(), std::back_inserter(cases));
    }
    return cases;
}

std::vector<SelftestResult> run_selftest(const std::vector<SelftestCase>& cases,
                                         const PictureMaker& maker) {
    std::vector<SelftestResult> results;
    Progress progress("selftest", static_cast<std::int64_t>(cases.size()));
    for (const SelftestCase& each : cases) {
        check_interrupt();
        progress.advance();
        const Stopwatch watch;
        CaseOutcome outcome;
        try {
            outcome = each.run(maker);
        } catch (const Interrupted&) {
            throw;
        } catch (const Error& error) {
            outcome.verdict = Verdict::refused;
            outcome.note = error.what();
        } catch (const std::exception& error) {
            outcome.verdict = Verdict::failed;
            outcome.note = error_text(error);
        }
        results.push_back(
            {each.group, each.scene, each.way, each.about, outcome, watch.milliseconds()});
    }
    return results;
}

std::size_t count_of(const std::vector<SelftestResult>& results, Verdict verdict) {
    return static_cast<std::size_t>(std::ranges::count(
        results, verdict, [](const SelftestResult& result) { return result.outcome.verdict; }));
}

std::string selftest_table(const std::vector<SelftestResult>& results) {
    std::string table = fmt::format("{:<12} {:<24} {:<36} {:>10} {:>10}  {}\n", "group", "scene",
                                    "way", "error", "bound", "verdict");
    for (const SelftestResult& result : results) {
        const CaseOutcome& outcome = result.outcome;
        table +=
            fmt::format("{:<12} {:<24} {:<36} {:>10.3g} {:>10.3g}  {}", result.group, result.scene,
                        result.way, outcome.error, outcome.bound, name_of(outcome.verdict));
        table += outcome.note.empty() ? "\n" : ": " + outcome.note + "\n";
    }
    return table;
}

std::string selftest_summary(const std::vector<SelftestResult>& results) {
    std::string summary;
    for (const std::string& group : selftest_groups()) {
        std::vector<SelftestResult> of_group;
        double ms = 0;
        for (const SelftestResult& result : results) {
            if (result.group != group) continue;
            of_group.push_back(result);
            ms += result.ms;
        }
        if (of_group.empty()) continue;
        summary +=
            fmt::format("{:<12} {:>4} passed, {} failed, {} refused, {:.1f} s\n", group,
                        count_of(of_group, Verdict::passed), count_of(of_group, Verdict::failed),
                        count_of(of_group, Verdict::refused), ms / 1000);
    }
    return summary;
}

nlohmann::ordered_json selftest_json(const std::vector<SelftestResult>& results) {
    nlohmann::ordered_json document;
    document["cases"] = nlohmann::ordered_json::array();
    for (const SelftestResult& result : results) {
        const CaseOutcome& outcome = result.outcome;
        document["cases"].push_back({{"group", result.group},
                                     {"scene", result.scene},
                                     {"way", result.way},
                                     {"verdict", name_of(outcome.verdict)},
                                     {"error", outcome.error},
                                     {"bound", outcome.bound},
                                     {"largest_error", outcome.largest_error},
                                     {"ms", result.ms},
                                     {"about", result.about},
                                     {"note", outcome.note}});
    }
    for (const Verdict verdict : {Verdict::passed, Verdict::failed, Verdict::refused})
        document["counts"][name_of(verdict)] = count_of(results, verdict);
    return document;
}

}  // namespace lamina::selftest
