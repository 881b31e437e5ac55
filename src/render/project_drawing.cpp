// SPDX-License-Identifier: Apache-2.0
#include "render/project_drawing.h"

#include <fmt/format.h>

#include <utility>

#include "base/client.h"
#include "base/enum_words.h"
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
// integration that is right everywhere. If the plan has another source, later views have nothing to
// choose.
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

// If the order is automatic and there is a tree, the order stays automatic, because leaves of a
// tree come from all over the mesh.
Resolved ProjectDrawing::resolve(Scene scene, const Plan& plan) const {
    const ProjectPlan& project = plan.project;
    ProjectSettings& settings = scene.project;
    if (settings.order.is_automatic() && !settings.tree)
        settings.order = order_of(project.visibility);
    settings.geometry = project.geometry;
    if (project.source == SegmentSource::analytic) settings.coloring = Coloring::analytic;
    scene.target = project.target;
    return Resolved(std::move(scene));
}

std::string ProjectDrawing::explanation(const Plan& plan, const Capabilities& capabilities) const {
    return explain(plan, facts_, capabilities);
}

Warnings ProjectDrawing::warnings(const Resolved& resolved, const Plan& /*plan*/) {
    const Scene& scene = resolved.scene();
    if (!data_warnings_) data_warnings_ = data_warnings(scene, *whole_);
    Warnings all = *data_warnings_;
    const auto add = [&](Warnings more) {
        for (std::string& warning : more) all.push_back(std::move(warning));
    };
    add(plan_warnings(scene, facts_.overlapping_tets));
    if (renderer_) add(frame_warnings(renderer_->order_report()));
    return all;
}

void ProjectDrawing::add_to(FrameStatistics& statistics) const {
    statistics.tets_drawn = renderer_->tets_drawn();
    const OrderReport& order = renderer_->order_report();
    statistics.counts["cycles"] = order.cycles;
    statistics.counts["cyclic_tets"] = order.cyclic_tets;
    statistics.counts["pairs_in_wrong_order"] = order.broken;
}

void ProjectDrawing::make_renderer(const Resolved& resolved, const Plan& plan,
                                   const Capabilities& capabilities) {
    const Scene& scene = resolved.scene();
    const bool same_mesh = renderer_ && renderer_->kept_mesh() == mesh_.get();
    auto made = make_project_renderer(*mesh_, *scene.transfer_function, plan.project, capabilities,
                                      scene.width, scene.height,
                                      same_mesh ? renderer_->parts() : ProjectParts());
    made->keep(mesh_);
    renderer_ = std::move(made);
}

}  // namespace lamina
