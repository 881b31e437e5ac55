// SPDX-License-Identifier: Apache-2.0
// A battery of stiff and extreme scenes, which shows whether this machine's drawing can be trusted.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "selftest/drawing_way.h"

namespace lamina::selftest {

enum class Verdict { passed, failed, refused };
const char* name_of(Verdict verdict);

struct CaseOutcome {
    Verdict verdict = Verdict::passed;
    double error = 0,
           bound = 0;          // in 1/255, in the pixel and channel that comes nearest to its bound
    double largest_error = 0;  // in 1/255, of all pixels
    std::string note;          // what failed, or why it was refused
};

// One picture of the self-test, or two that must agree, with the bounds that they must keep.
struct SelftestCase {
    std::string group, scene, way;
    std::string about;  // what is stiff or extreme, and where the bound comes from
    std::function<CaseOutcome(const PictureMaker&)> run;

    std::string name() const { return group + "/" + scene + "/" + way; }
};

// The groups in the order in which they run.
const std::vector<std::string>& selftest_groups();
// All cases, or those of the groups that are named. Throws UsageError for an unknown name.
std::vector<SelftestCase> selftest_cases(const std::vector<std::string>& groups);

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
