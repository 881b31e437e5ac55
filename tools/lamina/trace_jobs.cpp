// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <optional>

#include "base/stage.h"
#include "loaded_mesh.h"
#include "loaded_volume.h"
#include "reference/mesh_tracer.h"
#include "reference/volume_tracer.h"
#include "render_job.h"

namespace lamina {
namespace {

void record(double milliseconds, double error_estimate, RenderStats& stats) {
    stats.frames_ms = {milliseconds};
    stats.stages_ms["trace"] = milliseconds;
    stats.renderer = stats.context = "reference tracer";
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
        Stage frame("frame");
        frame.count("frame", 0);
        result_.emplace(trace(view));
        record(frame.end(), result_->error_estimate, stats);
    }

    void draw_frame(const View& view) override { trace(view); }

    std::size_t write(PictureFile& picture, const PictureAttributes& attributes) override {
        return picture.write(result_->image, request_.scene.background, attributes);
    }

  private:
    TraceResult trace(const View& view) const {
        const Stage tracing("trace");
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
        data_.emplace(request_, stats);
        Stage building("boundary_tree");
        tree_.emplace(data_->data.mesh, data_->data.mesh.open_faces());
        stats.stages_ms["boundary_tree"] = building.end();
        return make_plan(request_.scene, data_->facts, {}, request_.omissions);
    }

    std::string explanation(const Plan& plan) const override {
        return explain(plan, data_->facts, {});
    }

    void draw(const Plan&, const View& view, RenderStats& stats) override {
        Stage frame("frame");
        frame.count("frame", 0);
        result_.emplace(trace(view));
        record(frame.end(), result_->error_estimate, stats);
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
    MeshTraceResult trace(const View& view) const {
        const Stage tracing("trace");
        return trace_mesh(data_->data.mesh, *tree_, data_->data.scalar.values,
                          request_.scene.transfer_function, view);
    }

    const RenderRequest request_;
    std::optional<LoadedMesh> data_;
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
