// SPDX-License-Identifier: Apache-2.0
#include "render_stats.h"

#include <sys/resource.h>

#include <algorithm>

#include "base/median.h"

namespace lamina {
namespace {

using Json = nlohmann::ordered_json;

double peak_rss_mb() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) / 1024;  // Linux counts in KiB
}

const char* word_of(VolumeSampling sampling) {
    switch (sampling) {
        case VolumeSampling::none:
            return "none";
        case VolumeSampling::fetch:
            return "fetch";
        case VolumeSampling::filtered:
            return "filtered";
        default:
            return "hardware";
    }
}

Json plan_to_json(const Plan& plan) {
    Json json{{"method", name_of(plan.method)}};
    if (plan.method != Method::slice) return json;
    const SlicePlan& slice = plan.slice;
    json["target"] = name_of(slice.target);
    json["slabs"] = slice.slabs;
    json["classification"] = name_of(slice.classification);
    json["order"] = name_of(slice.order);
    json["sampling"] = word_of(slice.sampling);
    json["bricks"] = slice.bricks.size();
    if (slice.emulation) {
        const Emulation& emulation = *slice.emulation;
        json["emulate"] = {
            {"bits", emulation.bits},
            {"alpha", name_of(emulation.alpha)},
            {"over", name_of(emulation.over)},
            {"by", slice.blending == Blending::fetch ? "framebuffer_fetch" : "texture_barrier"}};
    }
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
        json["table"] = {{"scalars", slice.table.scalar_nodes},
                         {"lengths", slice.table.length_layers},
                         {"colored", slice.table.colored}};
    }
    return json;
}

}  // namespace

nlohmann::ordered_json to_json(const RenderStats& stats, const Plan& plan) {
    const auto& frames = stats.frames_ms;
    Json json;
    json["frame_ms"] = {{"median", median(frames)},
                        {"min", *std::min_element(frames.begin(), frames.end())},
                        {"max", *std::max_element(frames.begin(), frames.end())},
                        {"n", frames.size()}};
    json["stages"] = stats.stages_ms;
    json["samples"] = stats.samples;
    json["fragments"] = stats.fragments;
    json["tets_drawn"] = 0;
    json["bytes_gpu"] = stats.bytes_gpu;
    json["peak_rss_mb"] = peak_rss_mb();
    json["context"] = stats.context;
    json["plan"] = plan_to_json(plan);
    json["omitted"] = Json::array();
    for (const Omission& omission : plan.omitted) {
        json["omitted"].push_back({{"name", omission.name}, {"reason", omission.reason}});
    }
    json["counts"] = stats.counts;
    if (stats.mesh_error) json["mesh_error"] = *stats.mesh_error;
    if (stats.error_estimate) json["error_estimate"] = *stats.error_estimate;
    return json;
}

}  // namespace lamina
