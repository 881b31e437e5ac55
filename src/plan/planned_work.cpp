// SPDX-License-Identifier: Apache-2.0
#include "plan/planned_work.h"

#include <algorithm>

#include "base/enum_words.h"
#include "base/error.h"
#include "compositing/tree_shape.h"
#include "plan/planners.h"

namespace lamina {
namespace {

double pixels_of(const Scene& scene) {
    return static_cast<double>(scene.width) * scene.height;
}

double bytes_per_pixel(Target target) {
    switch (target) {
        case Target::float32:
            return 16;
        case Target::fixed8:
            return 4;
        case Target::float16:
        case Target::fixed16:
        case Target::emulated:
            return 8;
    }
    unreachable_enum();
}

// The engine `cpu` keeps bytes as words of four neighbours.
double volume_bytes(const SlicePlan& plan, const Facts& facts, bool tiles) {
    if (plan.sampling == VolumeSampling::none || plan.nothing_visible) return 0;
    const auto sample = static_cast<double>(plan.float_texture ? 4 : bytes_of(facts.type));
    const auto samples = static_cast<double>(facts.grid.sample_count());
    if (!tiles) return samples * sample;
    return facts.type == SampleType::uint8 || facts.type == SampleType::float32 ? 4 * samples
                                                                                : 2 * samples;
}

double table_bytes(const TableRequest& table) {
    return 4.0 * table.scalar_nodes * table.scalar_nodes *
           (table.colored ? 4 * table.length_layers : 1);
}

double passes_of(const SlicePlan& plan) {
    if (!plan.tree) return plan.slabs * static_cast<double>(plan.bricks.size());
    const TreeShape shape(plan.tree->factors, plan.slabs);
    double nodes = 1, all = 0;
    for (int level = 0; level < shape.levels(); ++level) {
        all += nodes;
        nodes = std::min<double>(nodes * shape.factor(level), plan.slabs);
    }
    return plan.tree->nodes == NodeArithmetic::fixed ? all + plan.slabs : all;
}

// Cells that a ray crosses per voxel edge of its length: 1 along an axis, 1.7 along a diagonal.
constexpr double cells_per_voxel = 1.5;

double share_of_rays(const SlicePlan& plan, const RayShares& shares) {
    const bool early = plan.ends_early();
    const double in_one_step = !plan.constant_regions ? 0.0
                               : early                ? shares.constant_before_opaque
                                                      : shares.constant;
    if (plan.occupied_only)
        return (early ? shares.occupied_before_opaque : shares.occupied) - in_one_step;
    return (early ? shares.box_before_opaque : shares.box) - in_one_step;
}

// A program that marches many slabs fetches each scalar once: a scalar between two slabs serves
// both.
double fetches_per_segment(const SlicePlan& plan) {
    if (plan.sampling == VolumeSampling::none) return 0;
    const double scalars = plan.classification != Classification::preintegrated ? 1
                           : plan.has_tree(NodeArithmetic::shader)              ? 2
                                                                                : 3;
    return plan.sampling == VolumeSampling::fetch ? 8 * scalars : scalars;
}

// Returns the plan as it would be without one of its omissions.
ProjectPlan without(ProjectPlan plan, const std::string& name) {
    if (name == "transparent_tets") plan.draw_transparent = plan.tree.empty();
    if (name == "drawing") plan.nothing_visible = false;
    if (name == "order") plan.visibility = OrderMethod::exact;
    if (name == "color") plan.table.request.colored = true;
    return plan;
}

}  // namespace

Work planned_work(const SlicePlan& plan, const Facts& facts, const Scene& scene, bool tiles) {
    Work work;
    work.bytes = volume_bytes(plan, facts, tiles) +
                 pixels_of(scene) * (tiles ? 16 : bytes_per_pixel(plan.target));
    if (plan.nothing_visible) return work;
    const double on_a_ray = plan.integrates_cells() ? cells_per_voxel * facts.voxels_along_view
                                                    : static_cast<double>(plan.slabs);
    work.segments = pixels_of(scene) * on_a_ray * share_of_rays(plan, facts.ray_shares);
    if (!tiles) work.fetches = work.segments * fetches_per_segment(plan);
    work.passes = passes_of(plan);
    if (plan.uses_table()) work.bytes += table_bytes(plan.table.request);
    if (plan.occupied_only)
        work.bytes += static_cast<double>(facts.occupied_bricks.distance.size());
    if (plan.constant_regions)
        work.bytes += 2 * static_cast<double>(facts.constant_bricks.kind.size());
    return work;
}

Work planned_work(const ProjectPlan& plan, const MeshFacts& facts, const Scene& scene) {
    Work work;
    work.bytes = pixels_of(scene) * bytes_per_pixel(plan.target);
    if (plan.nothing_visible) return work;
    const bool cut = plan.source == SegmentSource::parts;
    const auto transparent = static_cast<double>(facts.transparent_tets);
    const auto tets = static_cast<double>(facts.tets);
    work.tets = (cut ? static_cast<double>(facts.parts) : tets - transparent) +
                (plan.draw_transparent ? transparent : 0);
    work.ordered = plan.visibility == OrderMethod::none ? 0 : tets;
    if (plan.source == SegmentSource::cut_table || plan.source == SegmentSource::table)
        work.bytes += table_bytes(plan.table.request);
    return work;
}

void add_savings(Plan& plan, const Scene& scene, const Facts& facts,
                 const Capabilities& capabilities, const OmissionSwitch& omissions,
                 const SampleTrials& trials, TableCache& tables) {
    plan.work = planned_work(plan.slice, facts, scene, capabilities.tiles);
    const std::vector<std::string> names = omission_names();
    for (Omission& omission : plan.omitted) {
        if (std::ranges::find(names, omission.name) == names.end()) continue;
        OmissionSwitch kept = omissions;
        kept.kept.insert(omission.name);
        try {
            const Plan other = plan_slicing(scene, facts, capabilities, kept, trials, tables);
            omission.saves =
                planned_work(other.slice, facts, scene, capabilities.tiles) - plan.work;
        } catch (const Error&) {
            // Without this omission the context could not draw the scene at all: there is no work
            // to compare.
        }
    }
}

void add_savings(Plan& plan, const Scene& scene, const MeshFacts& facts) {
    plan.work = planned_work(plan.project, facts, scene);
    for (Omission& omission : plan.omitted) {
        omission.saves =
            planned_work(without(plan.project, omission.name), facts, scene) - plan.work;
    }
}

}  // namespace lamina
