// SPDX-License-Identifier: Apache-2.0
// Which bifurcation factors a study of compositing trees says to take.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "study/study_results.h"

namespace lamina::study {

constexpr const char* factors_key = "render.slice.tree.factors";

// The report's `plots` for runs of one scene with trees: L2 error and frame time over the tree's
// height and over its irregularity (LaMar 2004, section 6.3, asks for both). There is one series
// for each setting of the other swept keys. Empty if no run has a tree.
nlohmann::ordered_json tree_plots(const RunList& list, const std::vector<const RunResult*>& runs);

// Number of images that a tree composites into: 1 for the root, then those of each level above the
// slabs. 32x32 has 33 nodes, and 8x128 has 9.
std::int64_t nodes_of(const std::vector<int>& factors);

// Trees of one scene that differ in their factors only, and the run without a tree beside them.
struct TreeGroup {
    // A choice: the tree of the smallest L2 among those with at most `most_nodes` nodes and more
    // than those of the choice before it.
    struct Choice {
        std::int64_t most_nodes = 0;  // 1, 10, 100, ...
        const RunResult* run = nullptr;
    };

    std::string name;                     // of the other settings: "fixed8"
    bool in_floats = false;               // target float16 or float32
    std::vector<Choice> choices;          // by increasing number of nodes
    const RunResult* straight = nullptr;  // without a tree, or null

    const RunResult& best() const;  // smallest L2 of the choices
};

// Returns the groups of the runs of one scene; those in floats last. Empty if no tree is swept.
std::vector<TreeGroup> tree_groups(const RunList& list, const std::vector<const RunResult*>& runs);

// Returns one sentence for each group of a scene, in floats or not: the tree to take, its cost and
// its gain.
std::vector<std::string> tree_findings(const RunList& list, const std::string& scene,
                                       const std::vector<const RunResult*>& runs, bool in_floats);

// The tables that the page shows before all else, {title, note, tables: [{caption, rows}]}: the
// best factors at each number of nodes in all scenes, and the pictures without a tree, those in
// floats apart. Null if the study has no trees.
nlohmann::ordered_json tree_answers(const StudyResults& results);

}  // namespace lamina::study
