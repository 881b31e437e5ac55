// SPDX-License-Identifier: Apache-2.0
#pragma once

// Draws a scene from start to end: reads data, chooses what is automatic, plans, renders or traces,
// and collects statistics and warnings. All front ends draw through Pipeline.

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "annotation/annotation_layer.h"
#include "choice/choose.h"
#include "lamina/image.h"
#include "lamina/report.h"
#include "lamina/scene.h"
#include "lamina/settings.h"
#include "reference/tiles.h"
#include "render/draw_context.h"
#include "render/scene_data.h"
#include "render/scene_renderer.h"

namespace lamina {

// A picture of the reference tracer, or of its plain twin.
struct TracedPicture {
    PreciseImage image;  // associated RGBA, before any background
    // The largest error over all pixels and channels, as a share of full scale, as the tracer
    // estimates it.
    double error_estimate = 0;
    std::int64_t segments = 0;          // of rays, with extinction
    std::int64_t overlapping_rays = 0;  // rays that meet overlapping tets of a mesh
};

// Returns the scene with method trace, for its volume or its mesh.
Scene as_trace(Scene scene, TraceOf of);

// Traces the data that the scene draws, whatever the scene's method, to its tolerance
// (trace_tolerance). Transfer function and camera must not be automatic.
TracedPicture trace_picture(const Scene& scene, SceneData& data, const TileDone& tile_done = {});

// Traces with the plain twin of the tracer (plain/plain_tracer.h), which counts no overlapping rays
// and takes no tolerance.
TracedPicture plainly_traced_picture(const Scene& scene, SceneData& data);

struct PipelineOptions;

// Makes the object that draws the frames of a scene and its data.
using FramesMaker = std::function<std::unique_ptr<Frames>(const Scene& scene, SceneData& data,
                                                          const PipelineOptions& options)>;

struct PipelineOptions {
    Auto<ContextChoice> context = {};
    // Replaces `context` by the caller's OpenGL context, which has these capabilities. It must be
    // current whenever a member is called, and in the destructor.
    std::optional<Capabilities> capabilities = {};
    OmissionSwitch omissions = {};
    Adjustments adjustments = {};
    // Allows choices to take longer if that makes every frame faster. Otherwise the time to the
    // first picture counts.
    bool many_frames = false;
    bool count_fragments = false;  // with OpenGL this costs a query
    // Traces with the plain twin of the reference tracer, which does not report its tiles.
    bool trace_plainly = false;
    // The share of the work of a picture that this pipeline does, if several draw one picture
    // together with the cpu engine.
    PictureShare share = {};
    FramesMaker make_frames = {};  // replaces this process's own renderers
    // Cache of pre-integration tables. Pipelines that share it compute each table once.
    std::shared_ptr<TableCache> tables = std::make_shared<TableCache>();
};

// Draws a scene again and again while it changes. Each step is done when it is first needed, and
// again when a change makes it necessary (see SceneRenderer). Warnings go to the client that the
// thread works for (base/client.h). Members may throw Error.
class Pipeline {
  public:
    explicit Pipeline(Scene scene, SceneData data = {}, PipelineOptions options = {});
    ~Pipeline();
    Pipeline(const Pipeline&) = delete;
    Pipeline& operator=(const Pipeline&) = delete;

    // Loads the data that the scene draws. Other members call it if necessary.
    void load();

    const Scene& asked() const { return asked_; }
    // Returns the scene with transfer function and camera chosen, and changed as wished.
    const Scene& scene();
    // Returns sentences that say what was chosen; none if nothing was automatic.
    const std::vector<std::string>& reasons();
    const Scene& resolved_scene();  // with every "auto" that the method uses replaced
    SceneData& data() { return data_; }
    std::unique_ptr<Field> field() { return data_.field(scene()); }

    // Replaces the scene by another one of the same data. Its files are not read, with one
    // exception: a mesh file, if the mesh was made from the volume before.
    void set_scene(Scene scene);
    // Changes the scene that was asked for, and writes out what is chosen with these changes.
    void adjust(const Adjustments& adjustments);
    void set_camera(const Camera& camera);
    void set_size(int width, int height);  // pixels, 1 or more
    void set_transfer_function(const TransferFunction& transfer_function);
    // Takes the transfer function of another scene, which may be automatic or have an open colour
    // map.
    void set_transfer_function_of(const Scene& like);
    void set_clip(const Clip& clip);

    const Plan& plan();
    std::string explanation();  // the plan as text, after the sentences of reasons()
    // Returns lines that say what light costs in this scene: draws small pictures with and without
    // it, for which the data are set up a second time. If that fails, the lines say why. Empty if
    // nothing is lit, or if other processes draw.
    std::string light_cost();
    void warn_of_plan();  // warns about the plan and the data

    void set_up();
    // Makes the pipeline's context of OpenGL current while the result lives, so that the calls
    // between find it so: a GPU's driver flushes with each change. Returns null if it has none.
    std::unique_ptr<gl::CurrentContext> make_current() const;
    // Draws a frame with the scene's method, without reading it, so that it can be timed.
    void draw_frame();
    // Draws a picture, and warns about data, plan and picture.
    void draw(Image& picture);
    // Draws a picture without warnings about it.
    void draw_quietly(Image& picture);
    void read(Image& picture);  // gets the last frame or traced picture
    void warn_of(const Image& picture);
    // Traces the scene's data, whatever its method.
    const TracedPicture& trace(const TileDone& tile_done = {});
    const std::optional<TracedPicture>& traced() const { return traced_; }  // the last one

    // Returns times and counts of the last picture; its draw_ms is that of the frame alone.
    FrameStatistics statistics();
    FrameStatistics trace_statistics();  // of the last traced picture

    const Capabilities& capabilities();
    SceneRenderer& renderer();  // this process's own: make_frames must not be set

  private:
    struct TracePlan {
        Plan plan;
        std::string explanation;
    };

    Choices chosen();
    bool changes_mesh(const Scene& next) const;
    void take(Choices next);
    Frames& frames();
    std::unique_ptr<SceneRenderer> renderer_of(const Scene& scene);
    void drop_frames();
    template <typename Work>
    decltype(auto) in_context(const Work& work);
    void draw_counted();
    // Gets the frame that was drawn last. The context must be current.
    void read_frame(Image& picture);
    // Sets colour space and annotations of a picture of the scene.
    template <typename Real>
    void label(RgbaImage<Real>& picture);
    const AnnotatedData& annotated();
    const TracePlan& plan_of_trace();
    TracedPicture traced_now(const TileDone& tile_done);
    void check_data();  // as plans do
    void warn_of_scene();
    void warn_of_data();

    Scene asked_, scene_;
    std::vector<std::string> reasons_;  // of scene_
    Warnings choice_warnings_;          // warnings of choosing the scene
    bool chosen_ = false;               // scene_ is the choice for asked_
    SceneData data_;
    PipelineOptions options_;
    std::optional<DrawContext> context_;
    std::unique_ptr<Frames> frames_;
    SceneRenderer* own_ = nullptr;  // frames_ as SceneRenderer; null if make_frames made them
    std::optional<TracePlan> trace_plan_;
    std::optional<TracedPicture> traced_;
    // Properties that annotations tell of the data, which are `annotated_of_`.
    std::optional<AnnotatedData> annotated_;
    std::weak_ptr<const void> annotated_of_;
    std::pair<bool, bool> annotated_counted_;  // for labels, and for a colour bar
    Clip annotated_clip_;                      // of which labels and range are
    std::map<std::string, double> stages_ms_;
    std::optional<std::int64_t> counted_fragments_;
    int frames_drawn_ = 0;
    double frame_ms_ = 0, trace_ms_ = 0;
};

}  // namespace lamina
