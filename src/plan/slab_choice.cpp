// SPDX-License-Identifier: Apache-2.0
#include "plan/choices.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace lamina {
namespace {

// Share of the allowed error that trials may use: the pictures and rays that trials are compared
// with have errors, too, and the context that draws the picture rounds differently.
constexpr double used_share = 0.96;

// Exponent with which the largest error grows with the number of rays: on a quarter of a picture's
// rays the largest error was down to 1 / 1.37 of that on all (docs/precision.md).
constexpr double rays_power = 0.25;

// Factor by which more slabs must reduce the error to be worth their time.
constexpr double near_least = 1.2;

// Range of p in: error ~ 1 / slabs^p, within which errors count as being of second order (p = 2).
constexpr double least_order = 1.5, most_order = 3;

// Targets by ascending bytes a pixel; of two with equal bytes, the one with smaller steps first.
constexpr std::array smaller_targets{Target::fixed8, Target::fixed16, Target::float16};

TargetChoice smallest_target(TreeQuestion question) {
    const double share = question.max_error * target_share;
    for (const Target target : smaller_targets) {
        question.target = target;
        const double error = one_level_error_bound(question);
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

int slabs_per_voxel(const Facts& facts, double slabs) {
    return static_cast<int>(
        std::clamp(std::ceil(slabs * facts.voxels_along_view), 1.0, double{max_slabs}));
}

double slab_error_goal(const Scene& scene, double max_color, int slabs, double rays) {
    const double all_rays = static_cast<double>(scene.width) * scene.height;
    const double share = used_share * std::pow(std::min(rays / all_rays, 1.0), rays_power);
    const bool tree_given = given_tree(scene.slice.tree) != nullptr;
    if (scene.target.is_automatic()) {
        const double unknown = tree_given ? target_share * scene.max_error : 0;
        const double rounding = choose_target(scene, max_color, slabs).error;
        return share * (scene.max_error - std::max(rounding, unknown));
    }
    if (!scene.slice.tree || tree_given) return share * scene.max_error;
    TreeQuestion question;  // about a tree that needs no more than its root's rounding
    question.target = *scene.target;
    question.emulation = scene.emulate;
    const double root = one_level_error_bound(question);
    return share * std::max(scene.max_error - root, scene.max_error * target_share);
}

SlabTrial chosen_slabs(const Facts& facts, const SampleTrials& trials) {
    const SlabTrial two_per_voxel{slabs_per_voxel(facts, 2), NAN};
    if (trials.exact.empty()) return two_per_voxel;
    const double least = std::ranges::min(trials.exact, {}, &SlabTrial::error).error;
    const bool kept = std::ranges::any_of(trials.exact, &SlabTrial::keeps_goal);
    const auto unwanted = [&](const SlabTrial& trial) {
        if (kept) return !trial.keeps_goal();
        return trial.error > near_least * least || trial.slabs < two_per_voxel.slabs;
    };
    SlabTrial chosen{std::numeric_limits<int>::max()};
    for (const SlabTrial& trial : trials.exact) {
        if (!unwanted(trial) && trial.slabs < chosen.slabs) chosen = trial;
    }
    if (chosen.rays > 0) return chosen;
    return std::ranges::min(trials.exact, {}, &SlabTrial::error);
}

bool are_of_second_order(std::vector<SlabTrial> trials) {
    std::ranges::sort(trials, {}, &SlabTrial::slabs);
    const auto odd = [](const SlabTrial& a, const SlabTrial& b) {
        const double order = std::log(a.error / b.error) / std::log(double(b.slabs) / a.slabs);
        return !(order >= least_order && order <= most_order);
    };
    return std::ranges::adjacent_find(trials, odd) == trials.end();
}

std::optional<SlabTrial> slabs_of_hardware_filter(const SampleTrials& trials) {
    std::optional<SlabTrial> fewest;
    for (const SlabTrial& trial : trials.hardware) {
        if (trial.keeps_goal() && (!fewest || trial.slabs < fewest->slabs)) fewest = trial;
    }
    return fewest;
}

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
    return smallest_target(question);
}

TargetChoice choose_target(const Scene& scene, const Facts& facts, const SampleTrials& trials) {
    const std::optional<SlabTrial> filtered = slabs_of_hardware_filter(trials);
    const int slabs = scene.slice.samples.value_or(
        std::max(chosen_slabs(facts, trials).slabs, filtered ? filtered->slabs : 0));
    return choose_target(scene, largest_drawn_color(scene, facts.max_color), slabs);
}

Scene with_chosen_target(Scene scene, Target target) {
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
