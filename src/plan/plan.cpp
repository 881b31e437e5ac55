// SPDX-License-Identifier: Apache-2.0
#include "plan/plan.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/enum_words.h"
#include "base/error.h"
#include "compositing/tree_shape.h"
#include "plan/planners.h"

namespace lamina {
namespace {

std::string with_prefix(double amount) {
    if (amount >= 1e9) return fmt::format("{:.3g} G ", amount / 1e9);
    if (amount >= 1e6) return fmt::format("{:.3g} M ", amount / 1e6);
    if (amount >= 1e3) return fmt::format("{:.3g} k ", amount / 1e3);
    return fmt::format("{:.3g} ", amount);
}

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

// Returns the memory of the volume. The cpu engine (`tiles`) stores each sample of 8 bits with
// three neighbours, as a word.
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

// Typical number of cells a ray crosses per voxel edge: 1 along an axis, 1.7 along a diagonal.
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

// Returns the texel fetches for a segment. A program that marches many slabs fetches each scalar
// once: a scalar between two slabs serves both.
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

// Returns the plan of the tracer. `unread`: the omission of data that it does not read, if any.
Plan traced(const Scene& scene, const std::optional<Omission>& unread) {
    Plan plan;
    plan.method = scene.method;
    plan.omitted.push_back(
        {"context", "the tracer runs on the processor: no OpenGL context is made"});
    if (unread) plan.omitted.push_back(*unread);
    return plan;
}

}  // namespace

std::vector<std::pair<const char*, double>> Work::amounts() const {
    std::vector<std::pair<const char*, double>> found;
    const auto add = [&](const char* name, double amount) {
        if (amount != 0) found.emplace_back(name, amount);
    };
    add("segments", segments);
    add("fetches", fetches);
    add("tets", tets);
    add("ordered tets", ordered);
    add("passes", passes);
    add("bytes", bytes);
    return found;
}

Work operator-(const Work& a, const Work& b) {
    return {a.segments - b.segments, a.fetches - b.fetches, a.tets - b.tets,
            a.ordered - b.ordered,   a.passes - b.passes,   a.bytes - b.bytes};
}

std::string to_text(const Work& work) {
    std::string text;
    for (const auto& [name, amount] : work.amounts()) {
        if (amount > 0)
            text += fmt::format("{}{}{}", text.empty() ? "" : ", ", with_prefix(amount), name);
    }
    return text;
}

std::vector<std::string> omission_names() {
    return {"blending",
            "clip_planes",
            "color",
            "constant_regions",
            "double_precision",
            "drawing",
            "early_termination",
            "empty_space",
            "length_layers",
            "order",
            "perspective",
            "scalars",
            "smooth_points",
            "table",
            "transparent_tets",
            "volume_texture"};
}

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
    plan.work = planned_work(plan.slice, facts, scene, capabilities.cpu);
    const std::vector<std::string> names = omission_names();
    for (Omission& omission : plan.omitted) {
        if (std::ranges::find(names, omission.name) == names.end()) continue;
        OmissionSwitch kept = omissions;
        kept.kept.insert(omission.name);
        try {
            const Plan other = plan_slicing(scene, facts, capabilities, kept, trials, tables);
            omission.saves = planned_work(other.slice, facts, scene, capabilities.cpu) - plan.work;
        } catch (const Error&) {
            // Without this omission nothing could be drawn: there is no work to compare.
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

ErrorFigure SlicePlan::error() const {
    const bool bounded = nothing_visible || integrates_cells();
    if ((!bounded && !slab_trial) || !rounding_bound) return {};
    // Trials use the texture unit's filter only if they may choose it, not if the scene asks for
    // it.
    const bool tried_filter = sampling != VolumeSampling::hardware || !filter_reason.empty();
    if (!bounded && !tried_filter) return {};
    const double value =
        found_error() + *rounding_bound + (bounded ? surface_error : context_error);
    // An error of full scale says nothing.
    if (value >= 255) return {};
    if (bounded) {
        const bool leaves_out = ramp_error > 0 && !nothing_visible;
        const double along_ramps = found_error() + *rounding_bound + ramp_error;
        const bool lit = light_error > 0 && !nothing_visible;
        return {lit ? ErrorKind::estimated : ErrorKind::derived, value, 0,
                leaves_out ? along_ramps : 0};
    }
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

SlicedPicture of_all_views(SlicedPicture picture) {
    // A table of one layer does not depend on length.
    TableRequest& table = picture.table.request;
    if (!picture.uses_table() || table.length_layers == 1) table.max_length = 0;
    picture.table.error = 0;
    return picture;
}

Plan make_plan(const Scene& scene, const Facts& facts, const Capabilities& capabilities,
               const OmissionSwitch& omissions, const SampleTrials& trials,
               const std::shared_ptr<TableCache>& tables) {
    if (scene.method != Method::slice) {
        if (!scene.has_mesh()) return traced(scene, {});
        return traced(scene, Omission{"mesh", "the volume is traced: the mesh is not read"});
    }
    Plan plan = plan_alone(scene, facts, capabilities, omissions, trials, tables);
    const Scene chosen =
        with_classification(scene, {plan.slice.classification, plan.slice.slabs, {}});
    add_savings(plan, with_chosen_target(chosen, plan.slice.target), facts, capabilities, omissions,
                trials, *tables);
    return plan;
}

Plan plan_alone(const Scene& scene, const Facts& facts, const Capabilities& capabilities,
                const OmissionSwitch& omissions, const SampleTrials& trials,
                const std::shared_ptr<TableCache>& tables) {
    const ClassificationChoice classification =
        choose_classification(scene, facts, capabilities, trials);
    const Scene chosen = with_classification(scene, classification);
    const TargetChoice choice = choose_target(chosen, facts, trials);
    Plan plan = plan_slicing(with_chosen_target(chosen, choice.target), facts, capabilities,
                             omissions, trials, *tables);
    build_drawn_table(chosen, facts, plan.slice, *tables);
    plan.slice.classification_reason = classification.reason;
    plan.slice.target_reason = choice.reason;
    return plan;
}

Plan make_plan(const Scene& scene, const MeshFacts& facts, const Capabilities& capabilities,
               const OmissionSwitch& omissions, const std::shared_ptr<TableCache>& tables) {
    if (scene.method != Method::project) {
        if (!scene.has_volume() || scene.made_mesh() != nullptr) return traced(scene, {});
        return traced(scene, Omission{"volume", "the mesh is traced: the volume is not read"});
    }
    check_lit_projection(scene);
    check_limits(scene, capabilities);
    const TargetChoice choice = choose_project_target(scene);
    Plan plan = plan_projection(with_chosen_target(scene, choice.target), facts, capabilities,
                                omissions, *tables);
    plan.project.target_reason = choice.reason;
    add_savings(plan, scene, facts);
    return plan;
}

void check_limits(const Scene& scene, const Capabilities& capabilities) {
    const int edge = std::max(scene.width, scene.height);
    if (edge > capabilities.max_texture_size) {
        fail("{}: image: found {} x {} pixels, expected at most {} along an edge: {}",
             scene.file.string(), scene.width, scene.height, capabilities.max_texture_size,
             capabilities.renderer);
    }
    const std::uint64_t bytes =
        16 * static_cast<std::uint64_t>(scene.width) * static_cast<std::uint64_t>(scene.height);
    if (bytes > capabilities.max_texture_bytes) {
        fail("{}: image: found {} x {} pixels, expected at most {} in all: {}", scene.file.string(),
             scene.width, scene.height, capabilities.max_texture_bytes / 16, capabilities.renderer);
    }
}

Blending code_blending(const Capabilities& capabilities) {
    return capabilities.cpu ? Blending::tiles : Blending::registers;
}

const char* name_of(Blending blending) {
    return word_of(blending, {"blending_unit", "registers", "tiles"});
}

Dither dither_of(const DitherSettings& settings, int slabs) {
    return {settings.period.value_or(dither_period_for(slabs)), settings.seed, settings.color,
            settings.increment};
}

}  // namespace lamina
