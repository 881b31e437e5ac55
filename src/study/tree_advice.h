// SPDX-License-Identifier: Apache-2.0
// Findings of a study of compositing trees: which bifurcation factors to choose.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "study/study_results.h"

namespace lamina::study {

constexpr const char* factors_key = "render.slice.tree.factors";

// Returns the report's `plots` for runs of one scene with trees: L2 error and frame time over the
// tree's height and over its irregularity (LaMar 2004, section 6.3, asks for both), with one series
// for each setting of the other swept keys. Empty if no run has a tree.
nlohmann::ordered_json tree_plots(const RunList& list, const std::vector<const RunResult*>& runs);

// Returns the number of images that a tree composites into: 1 for the root, and those of each level
// above the slabs. 32x32 has 33 nodes, and 8x128 has 9.
std::int64_t nodes_of(const std::vector<int>& factors);

// Trees of one scene that differ in their factors only, and the run without a tree.
struct TreeGroup {
    // The tree with the smallest L2 among those with at most `most_nodes` nodes and more than the
    // previous choice's `most_nodes`.
    struct Choice {
        std::int64_t most_nodes = 0;  // 1, 10, 100, ...
        const RunResult* run = nullptr;
    };

    std::string name;                     // of the other settings: "fixed8"
    bool in_floats = false;               // target float16 or float32
    std::vector<Choice> choices;          // by increasing number of nodes
    const RunResult* straight = nullptr;  // the run without a tree, or null

    const RunResult& best() const;  // the choice with the smallest L2
};

// Returns the groups of the runs of one scene, those in floats last; none if no tree is swept.
std::vector<TreeGroup> tree_groups(const RunList& list, const std::vector<const RunResult*>& runs);

// Returns one sentence for each group of a scene, either those in floats or the others: the tree to
// choose, its cost and its gain.
std::vector<std::string> tree_findings(const RunList& list, const std::string& scene,
                                       const std::vector<const RunResult*>& runs, bool in_floats);

// Returns the tables that the page shows first, {title, note, tables: [{caption, rows}]}: the best
// factors at each number of nodes in all scenes, and the pictures without a tree; those in floats
// separately. Null if the study has no trees.
nlohmann::ordered_json tree_answers(const StudyResults& results);

}  // namespace lamina::study
