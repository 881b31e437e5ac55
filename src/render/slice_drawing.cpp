// SPDX-License-Identifier: Apache-2.0
#include "render/slice_drawing.h"

#include "compositing/codes.h"
#include "slicing/slab_trials.h"

namespace lamina {
namespace {

TreeSettings settings_of(const TreePlan& tree) {
    return {tree.factors, tree.nodes, tree.code, tree.alpha_bits};
}

}  // namespace

void SliceDrawing::measure_data(const Scene& scene) {
    facts_ = lamina::measure_data(scene, data_->volume, data_->bricks);
    trials_ = {};
    shares_.reset();
}

// The scene of a later view has its table already, so no rays are needed to choose one.
void SliceDrawing::measure_view(const Scene& scene, const Plan* planned) {
    lamina::measure_view(scene, facts_);
    if (planned != nullptr && scene.slice.table.is_given()) {
        facts_.ray_shares = measure_ray_shares(scene, data_->volume, facts_);
        facts_.scalar_rays = {};
    } else {
        measure_rays(scene, data_->volume, facts_);
    }
    // Shares stay when the view changes, so that their data stay, too.
    if (share_.count > 1 && !shares_)
        shares_.emplace(scene, facts_, data_->bricks, !data_->volume.in_memory(), share_.count);
}

void SliceDrawing::make_trials(const Scene& scene, const Capabilities& capabilities,
                               bool many_frames) {
    // Trial pictures of a volume in its files read more than faster frames would save.
    many_frames = many_frames && data_->volume.in_memory();
    trials_ = try_samples(scene, data_->volume, data_->bricks, facts_, capabilities, many_frames,
                          *tables_);
}

Plan SliceDrawing::plan(const Scene& scene, const Capabilities& capabilities,
                        const OmissionSwitch& omissions, bool for_people) const {
    const auto plan_with = [&](const OmissionSwitch& allowed) {
        return for_people ? make_plan(scene, facts_, capabilities, allowed, trials_, tables_)
                          : plan_alone(scene, facts_, capabilities, allowed, trials_, tables_);
    };
    Plan plan = plan_with(omissions);
    if (!shares_) return plan;
    // Slabs are tested for being constant several at a time, from the first one that a renderer
    // draws on. So the result would depend on the share, and on who draws a slab.
    if (plan.slice.constant_regions && !plan.slice.integrates_cells()) {
        OmissionSwitch fewer = omissions;
        fewer.kept.insert("constant_regions");
        plan = plan_with(fewer);
    }
    plan.slice.share = shares_->boxes()[static_cast<std::size_t>(share_.number)];
    return plan;
}

Resolved SliceDrawing::resolve(Scene scene, const Plan& plan) const {
    const SlicePlan& slice = plan.slice;
    SliceSettings& settings = scene.slice;
    settings.samples = slice.slabs;
    settings.classification = slice.classification;
    if (settings.filter.is_automatic())
        settings.filter =
            slice.sampling == VolumeSampling::hardware ? Filter::hardware : Filter::exact;
    if (settings.tree ? settings.tree->is_automatic()
                      : scene.target.is_automatic() && slice.target != Target::float32) {
        settings.tree.reset();
        if (slice.tree) settings.tree = settings_of(*slice.tree);
    }
    if (settings.dither && settings.dither->period.is_automatic())
        settings.dither->period = dither_period_for(slice.slabs);
    const TableRequest& table = slice.table.request;
    if (slice.uses_table() && table.colored)
        settings.table = SliceTableSettings{table.scalar_nodes, table.length_layers,
                                            table.max_length / slice.unit};
    scene.target = slice.target;
    return Resolved(std::move(scene));
}

std::vector<IndexBox> SliceDrawing::shares() const {
    return shares_ ? shares_->boxes() : std::vector<IndexBox>();
}

std::vector<int> SliceDrawing::front_to_back(const Scene& scene) const {
    if (!shares_) return {0};
    return shares_->front_to_back(facts_.grid, View(*scene.camera, scene.width, scene.height));
}

std::string SliceDrawing::explanation(const Plan& plan, const Capabilities& capabilities) const {
    return explain(plan, facts_, capabilities);
}

Warnings SliceDrawing::warnings(const Resolved& resolved, const Plan& plan) {
    Warnings all = data_warnings(*data_);
    for (std::string& warning : plan_warnings(resolved.scene(), plan.slice))
        all.push_back(std::move(warning));
    return all;
}

void SliceDrawing::make_renderer(const Resolved& resolved, const Plan& plan,
                                 const Capabilities& capabilities) {
    const Scene& scene = resolved.scene();
    const SliceParts ready = renderer_ ? renderer_->parts() : SliceParts();
    renderer_ = make_slice_renderer(data_->volume, *scene.transfer_function, facts_, plan.slice,
                                    capabilities, scene.width, scene.height, ready);
}

}  // namespace lamina
