// SPDX-License-Identifier: Apache-2.0
// Stiff and extreme scenes that show whether drawing on this machine can be trusted.
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
    std::string note;          // what failed, or why drawing was refused
};

// A picture of the self-test, or two that must agree, with their bounds.
struct SelftestCase {
    std::string group, scene, way;
    std::string about;  // why it is stiff or extreme, and where the bound comes from
    std::function<CaseOutcome(const PictureMaker&)> run;

    std::string name() const { return group + "/" + scene + "/" + way; }
};

// Returns the groups in the order in which they are drawn.
const std::vector<std::string>& selftest_groups();
// Returns all cases, or those of the named groups. Throws UsageError for an unknown name.
std::vector<SelftestCase> selftest_cases(const std::vector<std::string>& groups);

struct SelftestResult {
    std::string group, scene, way, about;
    CaseOutcome outcome;
    double ms = 0;
};

// Draws every case. A case that throws Error has the verdict "refused".
std::vector<SelftestResult> run_selftest(const std::vector<SelftestCase>& cases,
                                         const PictureMaker& maker);

std::size_t count_of(const std::vector<SelftestResult>& results, Verdict verdict);

// Return tables with one line for each case and for each group.
std::string selftest_table(const std::vector<SelftestResult>& results);
std::string selftest_summary(const std::vector<SelftestResult>& results);
// Returns {cases: [{group, scene, way, verdict, error, bound, largest_error, ms, about, note}],
// counts}.
nlohmann::ordered_json selftest_json(const std::vector<SelftestResult>& results);

}  // namespace lamina::selftest
