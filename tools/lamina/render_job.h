// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "lamina/scene.h"
#include "picture_file.h"
#include "plan/plan.h"
#include "render/context_choice.h"
#include "render_stats.h"
#include "scene/camera.h"
#include "scene_data.h"

namespace lamina {

// What a job of `lamina render` is given; all outlive it.
struct RenderRequest {
    const Scene& scene;
    const SceneData& data;
    const OmissionSwitch& omissions;
    ContextChoice context;  // --context
    bool count_fragments;   // somebody will read the statistics
    bool many_frames;       // the time of each counts
};

// One method of drawing a scene. Called in this order: plan(), then draw(), draw_frame() any number
// of times, write(); or, for each view of a series, draw_view(), write().
class RenderJob {
  public:
    virtual ~RenderJob() = default;
    // Loads what the method needs, measures it and plans.
    virtual Plan plan(RenderStats& stats) = 0;
    // The scene with all that was chosen for it, from plan() on; what other data may be drawn with.
    virtual Scene resolved_scene() = 0;
    // The plan as a text for people.
    virtual std::string explanation(const Plan& plan) const = 0;
    // The scene's own frame, with progress; its time goes into stats.frames_ms.
    virtual void draw(const Plan& plan, RenderStats& stats) = 0;
    // The same from elsewhere, to be timed; the picture of draw() stays.
    virtual void draw_frame(const Camera& camera) = 0;
    // The same from elsewhere, to be written. Its time is added to stats.frames_ms; the rest of the
    // statistics is that of the first view, but for the counts and errors, which are the largest.
    virtual void draw_view(const Camera& camera, const Plan& plan, RenderStats& stats) = 0;
    // Returns the number of pixels that were clamped.
    virtual std::size_t write(PictureFile& picture, const PictureAttributes& attributes) = 0;
};

std::unique_ptr<RenderJob> make_slice_job(const RenderRequest& request);
std::unique_ptr<RenderJob> make_project_job(const RenderRequest& request);
std::unique_ptr<RenderJob> make_volume_trace_job(const RenderRequest& request);
std::unique_ptr<RenderJob> make_mesh_trace_job(const RenderRequest& request);

}  // namespace lamina
