// SPDX-License-Identifier: Apache-2.0
#include "plan/target_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "plan/light_choice.h"
#include "plan/slab_choice.h"
#include "plan/tree_choice.h"

namespace lamina {
namespace {

// Ascending bytes; of the two with equal bytes, the one with the smaller steps first.
constexpr std::array smaller_targets{Target::fixed8, Target::fixed16, Target::float16};

template <typename Bound>
TargetChoice smallest_target(TreeQuestion question, const Bound& bound) {
    const double share = question.max_error * target_share;
    for (const Target target : smaller_targets) {
        question.target = target;
        const double error = bound(question);
        if (error <= share)
            return {target,
                    fmt::format("rounds by at most {:.2g} / 255, of which {:.2g} are its "
                                "share of max_error",
                                error, share),
                    error};
    }
    return {Target::float32,
            fmt::format("smaller targets round by more than {:.2g} / 255, their share of max_error",
                        share)};
}

}  // namespace

TargetChoice choose_target(const Scene& scene, double max_color, int slabs) {
    if (scene.target.is_given()) return {*scene.target, {}};
    if (const TreeSettings* const tree = given_tree(scene.slice.tree)) {
        if (tree->nodes == NodeArithmetic::fixed)
            return {Target::fixed16, "the most bits that fixed nodes can have"};
        return {Target::float32, "no smaller target has a bound for a tree of given factors"};
    }
    TreeQuestion question;
    question.visible_slabs = slabs;
    question.largest_color = max_color;
    question.max_error = scene.max_error;
    return smallest_target(question, one_level_error_bound);
}

TargetChoice choose_target(const Scene& scene, const Facts& facts, const SampleTrials& trials) {
    const std::optional<SlabTrial> filtered = slabs_of_hardware_filter(trials);
    const int slabs = scene.slice.samples.value_or(
        std::max(chosen_slabs(facts, trials).slabs, filtered ? filtered->slabs : 0));
    return choose_target(scene, largest_drawn_color(scene, facts.max_color), slabs);
}

Scene with_target(Scene scene, Target target) {
    if (scene.target.is_automatic() && target != Target::float32 && scene.method == Method::slice &&
        !scene.slice.tree)
        scene.slice.tree = automatic;
    scene.target = target;
    return scene;
}

TargetChoice choose_project_target(const Scene& scene) {
    if (scene.target.is_given()) return {*scene.target, {}};
    if (scene.project.tree)
        return {Target::fixed16, "the most bits that a tree over tets can have"};
    return {Target::float32,
            "tets are composited one by one, and each rounds: float32 alone keeps any max_error"};
}

}  // namespace lamina
