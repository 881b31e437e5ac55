// SPDX-License-Identifier: Apache-2.0
#include "render_stats.h"

#include <algorithm>

#include "base/arithmetic.h"
#include "base/enum_words.h"
#include "base/memory.h"

namespace lamina {
namespace {

using Json = nlohmann::ordered_json;

const char* word_of(VolumeSampling sampling) {
    switch (sampling) {
        case VolumeSampling::none:
            return "none";
        case VolumeSampling::fetch:
            return "fetch";
        case VolumeSampling::filtered:
            return "filtered";
        case VolumeSampling::hardware:
            return "hardware";
    }
    unreachable_enum();
}

void add_emulation(const CompositingPlan& plan, Json& json) {
    if (!plan.emulation) return;
    const Emulation& emulation = *plan.emulation;
    json["emulate"] = {{"bits", emulation.bits},
                       {"alpha", name_of(emulation.alpha)},
                       {"over", name_of(emulation.over)},
                       {"by", name_of(plan.blending)}};
}

Json project_to_json(const ProjectPlan& project) {
    Json json{{"method", name_of(Method::project)},
              {"target", name_of(project.target)},
              {"source", name_of(project.source)},
              {"interpolation", name_of(project.interpolation)},
              {"thickness", name_of(project.thickness)},
              {"order", name_of(project.visibility)},
              {"geometry", name_of(project.geometry)},
              {"dither", name_of(project.dither)}};
    add_emulation(project, json);
    if (!project.tree.empty()) {
        json["tree"] = {{"factors", project.tree},
                        {"nodes", name_of(NodeArithmetic::fixed)},
                        {"scattered", project.scattered}};
    }
    json["off_on_trial_rays"] = project.trial_error.segments;
    if (project.source == SegmentSource::table) {
        const TableRequest& table = project.table.request;
        json["table"] = {{"scalars", table.scalar_nodes},
                         {"lengths", table.colored ? table.length_layers : 1},
                         {"mapping", name_of(table.mapping)},
                         {"store", name_of(table.store)},
                         {"format", name_of(table.format)},
                         {"colored", table.colored}};
    } else if (project.source == SegmentSource::cut_table) {
        const TableRequest& table = project.table.request;
        json["table"] = {{"scalars", table.scalar_nodes},
                         {"lengths", table.length_layers},
                         {"colored", table.colored}};
    }
    return json;
}

Json slice_to_json(const SlicePlan& slice) {
    Json json{{"method", name_of(Method::slice)}};
    json["target"] = name_of(slice.target);
    json["slabs"] = slice.slabs;
    json["classification"] = name_of(slice.classification);
    json["order"] = name_of(slice.order);
    json["sampling"] = word_of(slice.sampling);
    json["bricks"] = slice.bricks.size();
    if (!slice.clip.empty()) json["clip_planes"] = slice.clip.size();
    add_emulation(slice, json);
    if (slice.dither) {
        json["dither"] = {{"period", slice.dither->period},
                          {"seed", slice.dither->seed},
                          {"color", slice.dither->color},
                          {"increment", slice.dither->increment}};
    }
    if (slice.tree) {
        json["tree"] = {{"factors", slice.tree->factors},
                        {"nodes", name_of(slice.tree->nodes)},
                        {"code", name_of(slice.tree->code)},
                        {"alpha_bits", slice.tree->alpha_bits}};
    }
    if (slice.error_bound) json["error_bound"] = *slice.error_bound;
    if (slice.uses_table()) {
        json["table"] = {{"scalars", slice.table.request.scalar_nodes},
                         {"lengths", slice.table.request.length_layers},
                         {"colored", slice.table.request.colored},
                         {"off_on_trial_rays", slice.table.error}};
    }
    return json;
}

Json to_json(const Work& work) {
    Json json = Json::object();
    for (const auto& [name, amount] : work.amounts()) json[name] = amount;
    return json;
}

// Returns the actual counts that correspond to the predictions of Plan::work.
Json actual_work(const FrameStatistics& picture, const Plan& plan) {
    Json json = Json::object();
    if (plan.method == Method::slice && picture.native) json["segments"] = picture.fragments;
    if (plan.method == Method::project) json["tets_drawn"] = picture.tets_drawn;
    if (plan.method != Method::trace)
        json["bytes"] = picture.native ? picture.bytes : picture.bytes_gpu;
    return json;
}

// Returns the stages for --stats, in which the measuring of data, facts and trials are one stage.
std::map<std::string, double> stages_of(const FrameStatistics& picture) {
    std::map<std::string, double> stages = picture.stages_ms;
    for (const char* const part : {"facts", "trials"}) {
        if (const auto found = stages.extract(part)) stages["measure"] += found.mapped();
    }
    return stages;
}

Json to_json(const ErrorFigure& error) {
    Json json{{"kind", name_of(error.kind)}, {"value", nullptr}};
    if (const auto known = error.known()) json["value"] = *known;
    if (error.rays > 0) json["rays"] = error.rays;
    if (error.along_ramps > 0) json["along_ramps"] = error.along_ramps;
    return json;
}

Json plan_to_json(const Plan& plan) {
    switch (plan.method) {
        case Method::slice:
            return slice_to_json(plan.slice);
        case Method::project:
            return project_to_json(plan.project);
        case Method::trace:
            return {{"method", name_of(plan.method)}};
    }
    unreachable_enum();
}

// Returns statistics of the times; null without frames, if earlier runs had written all pictures.
Json times_to_json(const std::vector<double>& frames) {
    if (frames.empty()) return {{"median", nullptr}, {"min", nullptr}, {"max", nullptr}, {"n", 0}};
    return {{"median", median(frames)},
            {"min", *std::min_element(frames.begin(), frames.end())},
            {"max", *std::max_element(frames.begin(), frames.end())},
            {"n", frames.size()}};
}

}  // namespace

void keep_largest(const std::map<std::string, std::int64_t>& counts,
                  std::map<std::string, std::int64_t>& largest) {
    for (const auto& [name, count] : counts) {
        const auto place = largest.emplace(name, count).first;
        place->second = std::max(place->second, count);
    }
}

void RunStatistics::add(const FrameStatistics& next) {
    if (frames_ms.empty()) {
        // Stages before the first picture belong to the plan that --stats writes; later views plan
        // again.
        std::map<std::string, double> stages = std::move(picture.stages_ms);
        stages.insert(next.stages_ms.begin(), next.stages_ms.end());
        picture = next;
        picture.stages_ms = std::move(stages);
    } else {
        keep_largest(next.counts, picture.counts);
        picture.trace_error = std::max(picture.trace_error, next.trace_error);
    }
    frames_ms.push_back(next.draw_ms);
}

nlohmann::ordered_json to_json(const RunStatistics& run, const Plan& plan) {
    const FrameStatistics& picture = run.picture;
    Json json;
    json["first_picture_ms"] = run.first_picture_ms;
    json["frame_ms"] = times_to_json(run.frames_ms);
    json["stages"] = stages_of(picture);
    json["samples"] = picture.slabs;
    json["fragments"] = picture.fragments;
    json["tets_drawn"] = picture.tets_drawn;
    json["bytes_gpu"] = picture.bytes_gpu;
    json["bytes_host"] = picture.bytes;
    json["peak_rss_mb"] = static_cast<double>(peak_resident_memory()) / (1 << 20);
    json["context"] = picture.drawn_by;
    json["plan"] = plan_to_json(plan);
    if (plan.method != Method::trace) json["error"] = to_json(plan.error());
    json["omitted"] = Json::array();
    for (const Omission& omission : plan.omitted) {
        json["omitted"].push_back({{"name", omission.name},
                                   {"reason", omission.reason},
                                   {"saves", to_json(omission.saves)}});
    }
    json["work"] = {{"predicted", to_json(plan.work)}, {"actual", actual_work(picture, plan)}};
    json["counts"] = picture.counts;
    if (picture.mesh_error) json["mesh_error"] = *picture.mesh_error;
    if (plan.method == Method::trace && !run.frames_ms.empty())
        json["error_estimate"] = picture.trace_error / 255;
    return json;
}

}  // namespace lamina
