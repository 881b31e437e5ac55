// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <optional>

#include "base/stopwatch.h"
#include "loaded_volume.h"
#include "reference/mesh_tracer.h"
#include "reference/volume_tracer.h"
#include "render_job.h"
#include "scene/scene_mesh.h"

namespace lamina {
namespace {

void record(double milliseconds, double error_estimate, RenderStats& stats) {
    stats.frames_ms = {milliseconds};
    stats.stages_ms["trace"] = milliseconds;
    stats.context = "reference tracer";
    stats.error_estimate = error_estimate;
}

class VolumeTraceJob : public RenderJob {
  public:
    explicit VolumeTraceJob(const RenderRequest& request) : request_(request) {}

    Plan plan(RenderStats& stats) override {
        data_.emplace(request_, stats);
        return make_plan(request_.scene, data_->facts, {}, request_.omissions);
    }

    std::string explanation(const Plan& plan) const override {
        return explain(plan, data_->facts, {});
    }

    void draw(const Plan&, const View& view, RenderStats& stats) override {
        const Stopwatch watch;
        result_.emplace(trace(view));
        record(watch.milliseconds(), result_->error_estimate, stats);
    }

    void draw_frame(const View& view) override { trace(view); }

    std::size_t write(PictureFile& picture, const PictureAttributes& attributes) override {
        return picture.write(result_->image, request_.scene.background, attributes);
    }

  private:
    TraceResult trace(const View& view) const {
        return trace_volume(data_->volume, request_.scene.transfer_function, view,
                            {request_.scene.trace_tolerance});
    }

    const RenderRequest request_;
    std::optional<LoadedVolume> data_;
    std::optional<TraceResult> result_;
};

class MeshTraceJob : public RenderJob {
  public:
    explicit MeshTraceJob(const RenderRequest& request) : request_(request) {}

    Plan plan(RenderStats& stats) override {
        const Stopwatch load_watch;
        data_.emplace(load_mesh(request_.scene));
        stats.stages_ms["load"] = load_watch.milliseconds();
        const Stopwatch measure_watch;
        facts_ = measure(request_.scene, *data_);
        stats.stages_ms["measure"] = measure_watch.milliseconds();
        const Stopwatch tree_watch;
        tree_.emplace(data_->mesh, data_->mesh.open_faces());
        stats.stages_ms["boundary_tree"] = tree_watch.milliseconds();
        count(stats);
        return make_plan(request_.scene, facts_);
    }

    std::string explanation(const Plan& plan) const override { return explain(plan, facts_); }

    void draw(const Plan&, const View& view, RenderStats& stats) override {
        const Stopwatch watch;
        result_.emplace(trace(view));
        record(watch.milliseconds(), result_->error_estimate, stats);
        stats.counts["segments"] = result_->segments;
        stats.counts["overlapping_rays"] = result_->overlapping_rays;
        if (result_->overlapping_rays > 0) {
            request_.message(fmt::format(
                "the mesh overlaps itself on the rays of {} pixels: its tets are composited there "
                "one after the other, as the ray enters them",
                result_->overlapping_rays));
        }
    }

    void draw_frame(const View& view) override { trace(view); }

    std::size_t write(PictureFile& picture, const PictureAttributes& attributes) override {
        return picture.write(result_->image, request_.scene.background, attributes);
    }

  private:
    void count(RenderStats& stats) const {
        const MeshFindings& findings = facts_.findings;
        stats.counts["tets"] = facts_.tets;
        stats.counts["degenerate_tets"] = findings.degenerate;
        stats.counts["inverted_tets"] = findings.inverted;
        stats.counts["duplicate_tets"] = findings.duplicates;
        stats.counts["nonmanifold_faces"] = findings.nonmanifold_faces;
        stats.counts["folded_faces"] = findings.folded_faces;
        stats.counts["non_finite_values"] = facts_.non_finite;
        count_cells(findings.cells, stats);
        if (data_->averaged) {
            stats.counts["averaged_arrays"] = 1;
            request_.message(fmt::format("\"{}\" is cell data: averaged to points", facts_.scalar));
        }
        if (facts_.non_finite > 0) {
            request_.message(
                fmt::format("{} values are NaN or infinite: their tets are drawn transparent",
                            facts_.non_finite));
        }
        if (data_->report) report_made(*data_->report, stats);
    }

    void count_cells(const CellCounts& cells, RenderStats& stats) const {
        stats.counts["split_cells"] = cells.split;
        stats.counts["skipped_cells"] = cells.skipped;
        stats.counts["straightened_cells"] = cells.straightened;
        if (cells.skipped > 0) {
            request_.message(
                fmt::format("{} cells have no volume and are not drawn", cells.skipped));
        }
        if (cells.straightened > 0) {
            request_.message(
                fmt::format("{} quadratic tets are drawn with straight edges", cells.straightened));
        }
    }

    void report_made(const MeshReport& report, RenderStats& stats) const {
        stats.mesh_error = report.relative_error();
        if (!report.within_tolerance && !request_.scene.mesh_request->kuhn) {
            request_.message(fmt::format(
                "the mesh stopped {} with {} tets: it differs from the volume by up to {:.3g} of "
                "the range of values, wanted {:.3g}",
                report.stopped_by_max_tets ? "at max_tets" : "where points would lie too close",
                report.tets, report.relative_error(), request_.scene.mesh_request->tolerance));
        }
    }

    MeshTraceResult trace(const View& view) const {
        return trace_mesh(data_->mesh, *tree_, data_->scalar.values,
                          request_.scene.transfer_function, view);
    }

    const RenderRequest request_;
    std::optional<SceneMesh> data_;
    MeshFacts facts_;
    std::optional<FaceTree> tree_;
    std::optional<MeshTraceResult> result_;
};

}  // namespace

std::unique_ptr<RenderJob> make_volume_trace_job(const RenderRequest& request) {
    return std::make_unique<VolumeTraceJob>(request);
}

std::unique_ptr<RenderJob> make_mesh_trace_job(const RenderRequest& request) {
    return std::make_unique<MeshTraceJob>(request);
}

}  // namespace lamina
