// SPDX-License-Identifier: Apache-2.0
#include "scene/slab_choice.h"

#include <algorithm>
#include <cmath>

#include "scene/target_choice.h"
#include "scene/tree_choice.h"

namespace lamina {

int slabs_per_voxel(const Facts& facts, double slabs) {
    return static_cast<int>(
        std::clamp(std::ceil(slabs * facts.voxels_along_view), 1.0, double{max_slabs}));
}

double slab_error_goal(const Scene& scene) {
    if (scene.automatic_target) return scene.max_error * (1 - target_share);
    if (!scene.slice.tree || !scene.slice.tree->automatic) return scene.max_error;
    TreeQuestion question;  // of a tree that needs no more than its root's rounding
    question.target = scene.target;
    question.emulation = scene.emulate;
    const double root = one_level_error_bound(question);
    return std::max(scene.max_error - root, scene.max_error * target_share);
}

SlabTrial chosen_slabs(const Scene& scene, const Facts& facts) {
    if (facts.slab_trials.empty()) return {slabs_per_voxel(facts, 2), NAN, 0};
    const double goal = slab_error_goal(scene);
    const auto kept = [goal](const SlabTrial& trial) { return trial.error <= goal; };
    const auto better = [&](const SlabTrial& a, const SlabTrial& b) {
        if (kept(a) != kept(b)) return kept(a);
        return kept(a) ? a.slabs < b.slabs : a.error < b.error;
    };
    return *std::ranges::min_element(facts.slab_trials, better);
}

}  // namespace lamina
