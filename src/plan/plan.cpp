// SPDX-License-Identifier: Apache-2.0
#include "plan/plan.h"

#include <utility>

#include "base/enum_words.h"
#include "plan/classification_choice.h"
#include "plan/planned_work.h"
#include "plan/planners.h"
#include "plan/target_choice.h"

namespace lamina {
namespace {

const Omission no_context{"context", "the tracer runs on the processor: no OpenGL context is made"};

}  // namespace

ErrorFigure SlicePlan::error() const {
    const bool bounded = nothing_visible || integrates_cells();
    if ((!bounded && !slab_trial) || !rounding_bound) return {};
    const double value = found_error() + *rounding_bound;
    // An error of full scale says nothing.
    if (value >= 255) return {};
    if (bounded) return {ErrorKind::derived, value, 0};
    return {ErrorKind::trials, value, slab_trial->rays};
}

ErrorFigure Plan::error() const {
    switch (method) {
        case Method::slice:
            return slice.error();
        case Method::project:
            return project.error;
        case Method::trace:
            return {};
    }
    unreachable_enum();
}

PlannedPicture of_all_views(PlannedPicture picture) {
    // A table of one layer does not depend on length.
    TableRequest& table = picture.table.request;
    if (!picture.uses_table() || table.length_layers == 1) table.max_length = 0;
    picture.table.error = 0;
    return picture;
}

Plan make_plan(const Scene& scene, const Facts& facts, const Capabilities& capabilities,
               const OmissionSwitch& omissions, const SampleTrials& trials,
               const std::shared_ptr<TableCache>& tables) {
    Plan plan;
    if (scene.method == Method::slice) {
        plan = plan_alone(scene, facts, capabilities, omissions, trials, tables);
        const Scene chosen =
            with_classification(scene, {plan.slice.classification, plan.slice.slabs, {}});
        add_savings(plan, with_target(chosen, plan.slice.target), facts, capabilities, omissions,
                    trials, *tables);
        return plan;
    }
    plan.method = scene.method;
    plan.omitted.push_back(no_context);
    if (scene.has_mesh())
        plan.omitted.push_back({"mesh", "the volume is traced: the mesh is not read"});
    return plan;
}

Plan plan_alone(const Scene& scene, const Facts& facts, const Capabilities& capabilities,
                const OmissionSwitch& omissions, const SampleTrials& trials,
                const std::shared_ptr<TableCache>& tables) {
    const ClassificationChoice way = choose_classification(scene, facts, capabilities, trials);
    const Scene chosen = with_classification(scene, way);
    const TargetChoice choice = choose_target(chosen, facts, trials);
    Plan plan = plan_slicing(with_target(chosen, choice.target), facts, capabilities, omissions,
                             trials, *tables);
    build_drawn_table(chosen, facts, plan.slice, *tables);
    plan.slice.classification_reason = way.reason;
    plan.slice.target_reason = choice.reason;
    return plan;
}

Plan make_plan(const Scene& scene, const MeshFacts& facts, const Capabilities& capabilities,
               const OmissionSwitch& omissions, const std::shared_ptr<TableCache>& tables) {
    Plan plan;
    if (scene.method == Method::project) {
        check_lit_projection(scene);
        check_limits(scene, capabilities);
        const TargetChoice choice = choose_project_target(scene);
        plan = plan_projection(with_target(scene, choice.target), facts, capabilities, omissions,
                               *tables);
        plan.project.target_reason = choice.reason;
        add_savings(plan, scene, facts);
        return plan;
    }
    plan.method = scene.method;
    plan.omitted.push_back(no_context);
    if (scene.has_volume() && scene.made_mesh() == nullptr)
        plan.omitted.push_back({"volume", "the mesh is traced: the volume is not read"});
    return plan;
}

}  // namespace lamina
