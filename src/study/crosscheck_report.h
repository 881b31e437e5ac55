// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "study/crosscheck.h"

namespace lamina::study {

// "1 slab", "64 slabs".
std::string slabs_text(int count);

// "99.9 %": the part's share of the difference.
std::string share_text(const ErrorBudget::Part& part);

// Facts that a report states beside the results of a cross-check.
struct CrosscheckSubject {
    std::string name;                    // name of the scene
    double wanted = 1;                   // largest error that counts as agreement, Linf in 1/255
    nlohmann::ordered_json environment;  // machine and version, for the report
};

// Returns the contents of budget.json: the error budget of the four pictures, and all results of
// both methods.
nlohmann::ordered_json budget_json(const Crosscheck& crosscheck, const ErrorBudget& budget,
                                   const CrosscheckSubject& subject);

// Returns the document that the page shows (docs/study.md).
nlohmann::ordered_json crosscheck_report(const Crosscheck& crosscheck, const ErrorBudget& budget,
                                         const CrosscheckSubject& subject);

// Returns the findings as sentences, for stdout and the page.
std::vector<std::string> crosscheck_findings(const Crosscheck& crosscheck,
                                             const ErrorBudget& budget,
                                             const CrosscheckSubject& subject);

}  // namespace lamina::study
