// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "study/crosscheck.h"

namespace lamina::study {

// What a crosscheck is told with.
struct CrosscheckSubject {
    std::string name;                    // of the scene
    double wanted = 1;                   // error that counts as agreement, Linf in 1/255
    nlohmann::ordered_json environment;  // of the report
};

// budget.json: the four pictures' parts, and the whole ladder of both methods.
nlohmann::ordered_json budget_json(const Crosscheck& crosscheck, const ErrorBudget& budget,
                                   const CrosscheckSubject& subject);

// The page's document (docs/study.md).
nlohmann::ordered_json crosscheck_report(const Crosscheck& crosscheck, const ErrorBudget& budget,
                                         const CrosscheckSubject& subject);

// Sentences for stdout and the page.
std::vector<std::string> crosscheck_findings(const Crosscheck& crosscheck,
                                             const ErrorBudget& budget,
                                             const CrosscheckSubject& subject);

}  // namespace lamina::study
