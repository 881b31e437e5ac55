// SPDX-License-Identifier: Apache-2.0
#include "render/project_drawing.h"

#include <fmt/format.h>

#include "base/unreachable.h"
#include "base/warning.h"
#include "projection/project_renderer.h"
#include "scene/clipped_mesh.h"

namespace lamina {
namespace {

ProjectOrder order_of(OrderMethod method) {
    switch (method) {
        case OrderMethod::mpvo:
            return ProjectOrder::mpvo;
        case OrderMethod::exact:
            return ProjectOrder::exact;
        case OrderMethod::centroid:
            return ProjectOrder::centroid;
        case OrderMethod::none:
            return ProjectOrder::none;
    }
    unreachable_enum();
}

// All renderers of a ProjectDrawing are of this kind.
const ProjectRenderer* as_project(const FrameRenderer* renderer) {
    return dynamic_cast<const ProjectRenderer*>(renderer);
}

}  // namespace

void ProjectDrawing::clip_mesh(const Scene& scene) {
    const bool lit = scene.lighting.has_value();
    if (scene.clip == clip_ && (lit_ || !lit)) return;
    clip_ = scene.clip;
    lit_ = lit;
    mesh_ = clipped_mesh(whole_, clip_, lit, name_of_mesh(scene));
    overlapping_tets_.reset();
    clipped_away_ = mesh_ == nullptr;
    if (clipped_away_) mesh_ = whole_;
}

void ProjectDrawing::measure_data(const Scene& scene) {
    clip_mesh(scene);
    facts_ = lamina::measure_data(scene, *mesh_);
    facts_.clipped_away = clipped_away_;
    measure_overlap(scene);
}

void ProjectDrawing::measure_overlap(const Scene& scene) {
    if (!is_right_order(scene.project.order)) return;
    if (!overlapping_tets_) overlapping_tets_ = lamina::measure_overlap(*mesh_, facts_.convexity);
    facts_.overlapping_tets = *overlapping_tets_;
}

// Trial rays choose between a table whose nodes lie on the transfer function's points and
// integration that is right everywhere. Where the plan has another source, later views have nothing
// to choose.
void ProjectDrawing::measure_view(const Scene& scene, const Plan* planned) {
    lamina::measure_view(scene, *mesh_, facts_);
    const bool settled = planned != nullptr && !planned->project.nothing_visible &&
                         planned->project.source != SegmentSource::cut_table;
    if (settled) {
        facts_.trial_rays.clear();
        facts_.last_error = planned->project.trial_error;
    } else {
        measure_rays(scene, *mesh_, facts_);
    }
}

Plan ProjectDrawing::plan(const Scene& scene, const Capabilities& capabilities,
                          const OmissionSwitch& omissions, bool /*for_people*/) const {
    return make_plan(scene, facts_, capabilities, omissions, tables_);
}

// Where the order is automatic and there is a tree, the order stays automatic, because leaves of a
// tree come from all over the mesh.
Scene ProjectDrawing::resolved(Scene scene, const Plan& plan) const {
    const ProjectPlan& project = plan.project;
    ProjectSettings& settings = scene.project;
    if (settings.order == ProjectOrder::automatic && !settings.tree)
        settings.order = order_of(project.visibility);
    settings.geometry = project.geometry;
    if (project.source == SegmentSource::analytic) settings.coloring = Coloring::analytic;
    scene.target = project.target;
    scene.automatic_target = false;
    return scene;
}

std::string ProjectDrawing::explanation(const Plan& plan, const Capabilities& capabilities) const {
    return explain(plan, facts_, capabilities);
}

Warnings ProjectDrawing::warnings(const Scene& scene, const Plan& /*plan*/,
                                  const FrameRenderer* renderer) {
    if (!data_warnings_) data_warnings_ = data_warnings(scene, *whole_);
    Warnings all = *data_warnings_;
    const auto add = [&](Warnings more) {
        for (std::string& warning : more) all.push_back(std::move(warning));
    };
    add(plan_warnings(scene, facts_.overlapping_tets));
    if (renderer != nullptr) add(frame_warnings(as_project(renderer)->order_report()));
    return all;
}

void ProjectDrawing::add_to(const FrameRenderer& renderer, FrameStatistics& statistics) const {
    const ProjectRenderer& drawn = *as_project(&renderer);
    statistics.tets_drawn = drawn.tets_drawn();
    const OrderReport& order = drawn.order_report();
    statistics.counts["cycles"] = order.cycles;
    statistics.counts["cyclic_tets"] = order.cyclic_tets;
    statistics.counts["pairs_in_wrong_order"] = order.broken;
}

std::unique_ptr<FrameRenderer> ProjectDrawing::make_renderer(const Scene& scene, const Plan& plan,
                                                             const Capabilities& capabilities,
                                                             FrameRenderer* before) const {
    const bool same_mesh = before != nullptr && as_project(before)->kept_mesh() == mesh_.get();
    auto renderer =
        make_project_renderer(*mesh_, scene.transfer_function, plan.project, capabilities,
                              scene.width, scene.height, same_mesh ? before : nullptr);
    renderer->keep(mesh_);
    return renderer;
}

}  // namespace lamina
