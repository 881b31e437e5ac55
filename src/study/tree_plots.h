// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "study/study_results.h"

namespace lamina::study {

constexpr const char* factors_key = "render.slice.tree.factors";

// Bifurcation factors of a run, from the root to the leaves; none: no tree is swept, or it failed.
std::vector<int> factors_of(const RunList& list, const RunResult& result);

// Largest factor to smallest: 1 of a regular tree.
double irregularity(const std::vector<int>& factors);

// Of runs of one scene with trees: L2 error and frame time over the tree's height and over its
// irregularity (LaMar 2004, section 6.3, asks for both), a series for whatever else is swept. The
// report's `plots`; empty where no run has a tree.
nlohmann::ordered_json tree_plots(const RunList& list, const std::vector<const RunResult*>& runs);

}  // namespace lamina::study
