// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>

#include "base/stage.h"
#include "loaded_mesh.h"
#include "reference/scene_tracer.h"
#include "render/warnings.h"
#include "render_job.h"

namespace lamina {
namespace {

void record(double milliseconds, double error_estimate, RenderStats& stats) {
    stats.frames_ms.push_back(milliseconds);
    stats.stages_ms.emplace("trace", milliseconds);
    stats.renderer = stats.context = "reference tracer";
    stats.error_estimate = std::max(error_estimate, stats.error_estimate.value_or(0));
}

class VolumeTraceJob : public RenderJob {
  public:
    explicit VolumeTraceJob(const RenderRequest& request) : request_(request) {}

    Plan plan(RenderStats& stats) override {
        Stage measuring("facts");
        facts_ = measure(request_.scene, data_.volume, data_.bricks);
        stats.stages_ms["measure"] += measuring.end();
        stats.counts["non_finite_samples"] = data_.bricks.non_finite;
        warn_of_all(data_warnings(data_));
        return make_plan(request_.scene, facts_, {}, request_.omissions);
    }

    Scene resolved_scene() override { return request_.scene; }

    std::string explanation(const Plan& plan) const override { return explain(plan, facts_, {}); }

    void draw(const Plan& plan, RenderStats& stats) override {
        draw_view(request_.scene.camera, plan, stats);
    }

    void draw_view(const Camera& camera, const Plan&, RenderStats& stats) override {
        Stage frame("frame");
        frame.count("frame", static_cast<double>(stats.frames_ms.size()));
        result_.emplace(trace(camera));
        record(frame.end(), result_->error_estimate, stats);
        warn_of_picture(request_.scene, *request_.data.field(), to_float(result_->image));
    }

    void draw_frame(const Camera& camera) override { trace(camera); }

    std::size_t write(PictureFile& picture, const PictureAttributes& attributes) override {
        return picture.write(result_->image, request_.scene.background, attributes,
                             request_.scene.color_space);
    }

  private:
    TraceResult trace(const Camera& camera) const {
        const Stage tracing("trace");
        Scene scene = request_.scene;
        scene.camera = camera;
        return lamina::trace(scene, data_.volume);
    }

    const RenderRequest request_;
    const VolumeData& data_ = *request_.data.volume;
    Facts facts_;
    std::optional<TraceResult> result_;
};

class MeshTraceJob : public RenderJob {
  public:
    explicit MeshTraceJob(const RenderRequest& request) : request_(request) {}

    Plan plan(RenderStats& stats) override {
        Stage measuring("measure");
        facts_ = measure(request_.scene, data_);
        stats.stages_ms["measure"] = measuring.end();
        report_mesh(data_, stats);
        warn_of_all(data_warnings(request_.scene, data_));
        Stage building("boundary_tree");
        tree_.emplace(data_.mesh, data_.mesh.open_faces());
        stats.stages_ms["boundary_tree"] = building.end();
        return make_plan(request_.scene, facts_, {}, request_.omissions);
    }

    Scene resolved_scene() override { return request_.scene; }

    std::string explanation(const Plan& plan) const override { return explain(plan, facts_, {}); }

    void draw(const Plan& plan, RenderStats& stats) override {
        draw_view(request_.scene.camera, plan, stats);
    }

    void draw_view(const Camera& camera, const Plan&, RenderStats& stats) override {
        Stage frame("frame");
        frame.count("frame", static_cast<double>(stats.frames_ms.size()));
        result_.emplace(trace(camera));
        record(frame.end(), result_->error_estimate, stats);
        warn_of_picture(request_.scene, *request_.data.field(), to_float(result_->image));
        keep_largest(
            {{"segments", result_->segments}, {"overlapping_rays", result_->overlapping_rays}},
            stats.counts);
        warn_of_all(trace_warnings(result_->overlapping_rays));
    }

    void draw_frame(const Camera& camera) override { trace(camera); }

    std::size_t write(PictureFile& picture, const PictureAttributes& attributes) override {
        return picture.write(result_->image, request_.scene.background, attributes,
                             request_.scene.color_space);
    }

  private:
    MeshTraceResult trace(const Camera& camera) const {
        const Stage tracing("trace");
        Scene scene = request_.scene;
        scene.camera = camera;
        return lamina::trace(scene, data_, *tree_);
    }

    const RenderRequest request_;
    const SceneMesh& data_ = *request_.data.mesh;
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
