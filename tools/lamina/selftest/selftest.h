// SPDX-License-Identifier: Apache-2.0
// A battery of stiff and extreme scenes, which shows whether this machine's drawing can be trusted.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "selftest/selftest_case.h"

namespace lamina::selftest {

struct SelftestResult {
    std::string group, scene, way, about;
    CaseOutcome outcome;
    double ms = 0;
};

// Runs every case. A case that throws Error has the outcome "refused".
std::vector<SelftestResult> run_selftest(const std::vector<SelftestCase>& cases,
                                         const PictureMaker& maker);

std::size_t count_of(const std::vector<SelftestResult>& results, Verdict verdict);

// A table for people: one line a case, and a summary of each group.
std::string selftest_table(const std::vector<SelftestResult>& results);
std::string selftest_summary(const std::vector<SelftestResult>& results);
// {cases: [{group, scene, way, verdict, error, bound, largest_error, ms, about, note}], counts}.
nlohmann::ordered_json selftest_json(const std::vector<SelftestResult>& results);

}  // namespace lamina::selftest
