// SPDX-License-Identifier: Apache-2.0
#include "scene/slab_choice.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/target_choice.h"
#include "scene/tree_choice.h"

namespace lamina {
namespace {

// The largest error on a quarter of a picture's rays was up to 4 % below that on all; as much is
// for the error of the picture that trials are compared with.
constexpr double tried_share = 0.92, all_tried_share = 0.96;

// What more slabs gain less than is not worth their time.
constexpr double near_least = 1.2;

}  // namespace

int slabs_per_voxel(const Facts& facts, double slabs) {
    return static_cast<int>(
        std::clamp(std::ceil(slabs * facts.voxels_along_view), 1.0, double{max_slabs}));
}

double slab_error_goal(const Scene& scene, double max_color, int slabs, bool all_rays) {
    const double share = all_rays ? all_tried_share : tried_share;
    const auto& tree = scene.slice.tree;
    if (scene.automatic_target) {
        const double unknown = tree && !tree->automatic ? target_share * scene.max_error : 0;
        const double rounding = choose_target(scene, max_color, slabs).error;
        return share * (scene.max_error - std::max(rounding, unknown));
    }
    if (!tree || !tree->automatic) return share * scene.max_error;
    TreeQuestion question;  // of a tree that needs no more than its root's rounding
    question.target = scene.target;
    question.emulation = scene.emulate;
    const double root = one_level_error_bound(question);
    return share * std::max(scene.max_error - root, scene.max_error * target_share);
}

SlabTrial chosen_slabs(const Facts& facts) {
    const SlabTrial two_per_voxel{slabs_per_voxel(facts, 2), NAN};
    if (facts.slab_trials.empty()) return two_per_voxel;
    const double least = std::ranges::min(facts.slab_trials, {}, &SlabTrial::error).error;
    const bool kept = std::ranges::any_of(facts.slab_trials, &SlabTrial::keeps_goal);
    const auto unwanted = [&](const SlabTrial& trial) {
        if (kept) return !trial.keeps_goal();
        return trial.error > near_least * least || trial.slabs < two_per_voxel.slabs;
    };
    SlabTrial chosen{std::numeric_limits<int>::max()};
    for (const SlabTrial& trial : facts.slab_trials) {
        if (!unwanted(trial) && trial.slabs < chosen.slabs) chosen = trial;
    }
    if (chosen.rays > 0) return chosen;
    return std::ranges::min(facts.slab_trials, {}, &SlabTrial::error);
}

std::optional<SlabTrial> slabs_of_hardware_filter(const Facts& facts) {
    std::optional<SlabTrial> fewest;
    for (const SlabTrial& trial : facts.filter_trials) {
        if (trial.keeps_goal() && (!fewest || trial.slabs < fewest->slabs)) fewest = trial;
    }
    return fewest;
}

}  // namespace lamina
