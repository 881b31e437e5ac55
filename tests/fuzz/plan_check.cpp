// SPDX-License-Identifier: Apache-2.0
#include "plan_check.h"

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "plan/choices.h"
#include "plan/plan.h"
#include "violation.h"

namespace lamina::fuzz {
namespace {

// Returns the capabilities of the cpu engine (tiles/cpu_capabilities.h), of Mesa's OpenGL and of a
// GPU.
std::array<Capabilities, 3> usual_capabilities() {
    constexpr int any = std::numeric_limits<int>::max();
    Capabilities native, mesa, gpu;
    native.renderer = "native";
    native.cpu = true;
    native.max_texture_size = 32768;
    native.max_3d_texture_size = any;
    native.max_texture_bytes = any;
    mesa.renderer = "software";
    mesa.max_texture_size = 16384;
    mesa.max_3d_texture_size = 2048;
    mesa.exact_float_filter = true;
    gpu = mesa;
    gpu.renderer = "GPU";
    gpu.software = gpu.exact_float_filter = false;
    gpu.eight_bit_filter = true;
    return {native, mesa, gpu};
}

void check_work(const Work& work, const char* what) {
    for (const auto& [name, amount] : work.amounts())
        require_finite(amount, std::string(what) + ": " + name);
}

void check_plan(const Plan& plan) {
    check_work(plan.work, "a frame's work");
    for (const auto& [name, amount] : plan.work.amounts()) require(amount >= 0, "work below 0");
    for (const Omission& omission : plan.omitted) check_work(omission.saves, "saved work");
}

void check_slicing(const SlicePlan& plan) {
    require(plan.slabs >= 1 && plan.slabs <= max_slabs, "slabs beyond their limit");
    require(!plan.bricks.empty(), "no brick");
    const TableRequest& table = plan.table.request;
    require_finite(table.max_length, "the table's length");
    require(table.length_layers >= 1 && table.scalar_nodes >= 2, "an empty table");
    if (plan.error_bound) require_finite(*plan.error_bound, "the bound of the error");
    require(!std::isnan(plan.opaque_depth), "the depth at which rays end is no number");
    if (plan.tree) require(!plan.tree->factors.empty(), "a tree without levels");
}

void check_projection(const ProjectPlan& plan) {
    require_finite(plan.near_depth, "the near plane");
    require_finite(plan.trial_error.segments, "the error of segments");
    require(plan.nothing_visible || plan.range.lo < plan.range.hi, "an empty range");
    require_finite(plan.table.request.max_length, "the table's length");
}

// Returns results as slicing/slab_trials.h would find them by drawing pictures: twice the slabs
// have half the error.
std::vector<SlabTrial> made_up_trials(const Scene& scene, const Facts& facts) {
    std::vector<SlabTrial> trials;
    double error = 64;
    for (const double slabs : {1, 2, 4, 8}) {
        const int number = slabs_per_voxel(facts, slabs);
        const double goal = slab_error_goal(scene, facts.max_color, number, 1000);
        require_finite(goal, "what the slabs' error may be");
        trials.push_back({number, error, 1000, goal});
        error /= 2;
    }
    return trials;
}

void check_facts(const Facts& facts) {
    require_finite(facts.side_ratio, "the ratio of sides");
    require_finite(facts.max_extinction, "the largest extinction");
    require_finite(facts.max_color, "the largest colour");
    require_finite(facts.near_depth, "the nearest depth");
    require_finite(facts.far_depth, "the farthest depth");
    require_finite(facts.voxels_along_view, "the number of voxels along the view");
    require_finite(facts.max_length_per_depth, "the longest ray");
    const RayShares& shares = facts.ray_shares;
    for (const double share :
         {shares.box, shares.occupied, shares.constant, shares.box_before_opaque,
          shares.occupied_before_opaque, shares.constant_before_opaque, facts.occupied_share,
          facts.constant_bricks.share}) {
        require(share >= 0 && share <= 1 + 1e-9, "a share is " + std::to_string(share));
    }
}

// Calls make_plan_for(capabilities, omissions) for all usual contexts, with omissions and without.
// Each call may throw Error.
template <typename MakePlan>
void for_all_contexts(const MakePlan& make_plan_for) {
    for (const Capabilities& capabilities : usual_capabilities()) {
        for (const bool none : {false, true}) {
            may_fail([&] { make_plan_for(capabilities, OmissionSwitch{none, {}}); });
        }
    }
}

}  // namespace

void check_slice_plans(const Scene& scene, const Volume& volume) {
    const Facts facts = measure(scene, volume, measure_bricks(volume));
    SampleTrials trials;
    check_facts(facts);
    if (scene.method == Method::slice && scene.slice.samples.is_automatic()) {
        trials.exact = made_up_trials(scene, facts);
        if (scene.slice.filter.is_automatic()) trials.hardware = trials.exact;
    }
    for_all_contexts([&](const Capabilities& capabilities, const OmissionSwitch& omissions) {
        const Plan plan = make_plan(scene, facts, capabilities, omissions, trials);
        check_plan(plan);
        if (plan.method == Method::slice) check_slicing(plan.slice);
        require(!explain(plan, facts, capabilities).empty(), "nothing to explain");
    });
}

void check_project_plans(const Scene& scene, const SceneMesh& mesh) {
    const MeshFacts facts = measure(scene, mesh);
    require_finite(facts.longest_edge, "the longest edge");
    require_finite(facts.diagonal, "the diagonal");
    for_all_contexts([&](const Capabilities& capabilities, const OmissionSwitch& omissions) {
        const Plan plan = make_plan(scene, facts, capabilities, omissions);
        check_plan(plan);
        if (plan.method == Method::project) check_projection(plan.project);
        require(!explain(plan, facts, capabilities).empty(), "nothing to explain");
    });
}

Scene scene_around(const Box& box, double lowest, double highest, Method method) {
    Scene scene;
    scene.file = "scene.json";
    const double middle = lowest / 2 + highest / 2;
    std::vector<TransferKnot> knots{{lowest, {glm::dvec3(0), 0}}};
    if (middle > lowest) knots.push_back({middle, {glm::dvec3(1, 0.5, 0), 1}});
    if (highest > knots.back().value) knots.push_back({highest, {glm::dvec3(0, 0.5, 1), 3}});
    scene.transfer_function = TransferFunction::linear(std::move(knots));
    scene.camera->center = box.min / 2.0 + box.max / 2.0;
    const double away =
        std::max({box.max.x - box.min.x, box.max.y - box.min.y, box.max.z - box.min.z, 1e-30});
    scene.camera->eye = scene.camera->center + glm::dvec3(0.3, 0.2, 3) * away;
    scene.width = scene.height = 8;
    scene.method = method;
    return scene;
}

}  // namespace lamina::fuzz
