// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "study/study_results.h"

namespace lamina::study {

constexpr const char* factors_key = "render.slice.tree.factors";

// The bifurcation factors of a run, from the root to the leaves. Empty where no tree is swept or
// the run failed.
std::vector<int> factors_of(const RunList& list, const RunResult& result);

// A name of the run's other settings: "fixed8".
std::string name_without_factors(const StudyRun& run);

// The largest factor over the smallest: 1 for a regular tree.
double irregularity(const std::vector<int>& factors);

// The report's `plots` for runs of one scene with trees: L2 error and frame time over the tree's
// height and over its irregularity (LaMar 2004, section 6.3, asks for both). There is one series
// for each setting of the other swept keys. Empty where no run has a tree.
nlohmann::ordered_json tree_plots(const RunList& list, const std::vector<const RunResult*>& runs);

}  // namespace lamina::study
