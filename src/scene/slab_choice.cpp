// SPDX-License-Identifier: Apache-2.0
#include "scene/slab_choice.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/target_choice.h"
#include "scene/tree_choice.h"

namespace lamina {
namespace {

// The largest error on a quarter of a picture's rays was up to 4 % below that on all.
constexpr double tried_share = 0.92;

// What more slabs gain less than is not worth their time.
constexpr double near_least = 1.2;

}  // namespace

int slabs_per_voxel(const Facts& facts, double slabs) {
    return static_cast<int>(
        std::clamp(std::ceil(slabs * facts.voxels_along_view), 1.0, double{max_slabs}));
}

double slab_error_goal(const Scene& scene) {
    if (scene.automatic_target) return tried_share * scene.max_error * (1 - target_share);
    if (!scene.slice.tree || !scene.slice.tree->automatic) return tried_share * scene.max_error;
    TreeQuestion question;  // of a tree that needs no more than its root's rounding
    question.target = scene.target;
    question.emulation = scene.emulate;
    const double root = one_level_error_bound(question);
    return tried_share * std::max(scene.max_error - root, scene.max_error * target_share);
}

SlabTrial chosen_slabs(const Facts& facts) {
    const SlabTrial two_per_voxel{slabs_per_voxel(facts, 2), NAN, 0};
    if (facts.slab_trials.empty()) return two_per_voxel;
    const double least = std::ranges::min(facts.slab_trials, {}, &SlabTrial::error).error;
    const bool kept = least <= facts.slab_goal;
    const double most = kept ? facts.slab_goal : near_least * least;
    const auto unwanted = [&](const SlabTrial& trial) {
        return trial.error > most || (!kept && trial.slabs < two_per_voxel.slabs);
    };
    SlabTrial chosen{std::numeric_limits<int>::max(), 0, 0};
    for (const SlabTrial& trial : facts.slab_trials) {
        if (!unwanted(trial) && trial.slabs < chosen.slabs) chosen = trial;
    }
    if (chosen.rays > 0) return chosen;
    return std::ranges::min(facts.slab_trials, {}, &SlabTrial::error);
}

std::optional<SlabTrial> slabs_of_hardware_filter(const Facts& facts) {
    std::optional<SlabTrial> fewest;
    for (const SlabTrial& trial : facts.filter_trials) {
        if (trial.error <= facts.slab_goal && (!fewest || trial.slabs < fewest->slabs))
            fewest = trial;
    }
    return fewest;
}

}  // namespace lamina
