// SPDX-License-Identifier: Apache-2.0
#pragma once

// Draws one scene and its data, from the first picture to the last: all pictures but those of the
// reference tracers are drawn by a SceneRenderer.

#include <map>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "lamina/image.h"
#include "lamina/report.h"
#include "lamina/scene.h"
#include "plan/capabilities.h"
#include "plan/plan.h"
#include "render/warnings.h"
#include "scene/scene.h"
#include "volume/volume_data.h"

namespace lamina {

// The part of a volume that one of several renderers draws, which draw one picture together.
struct PictureShare {
    int number = 0;  // 0 .. count - 1
    int count = 1;
};

// Names the automatic keys that the scene's method needs. Tables are left out: they are chosen with
// each view. So is the order of tets below a tree: its leaves take tets from all over the mesh,
// which no word for an order says.
std::vector<std::string> open_keys(const Scene& scene);

// A scene in which everything that its method needs was chosen: it has no open_keys(). Only a
// Drawing makes one from a plan. Later views are planned, and pictures drawn, from it.
class Resolved {
  public:
    explicit Resolved(Scene scene);

    const Scene& scene() const { return scene_; }
    // Calls change_scene(scene), which must leave nothing open.
    template <typename Change>
    void change(const Change& change_scene) {
        change_scene(scene_);
    }

  private:
    Scene scene_;
};

// Draws one scene of method slice or project again and again while it changes. What is automatic is
// chosen for the first picture and kept until set_scene().
class Frames {
  public:
    virtual ~Frames() = default;

    virtual const Scene& scene() const = 0;  // as asked for, with "auto"
    // Replaces the scene by another one with the same data and method.
    virtual void set_scene(Scene scene) = 0;
    virtual void set_camera(const Camera& camera) = 0;
    // These may keep more than set_scene() does.
    virtual void set_size(int width, int height);
    virtual void set_transfer_function(const TransferFunction& transfer_function);
    virtual void set_clip(const Clip& clip);

    virtual const Resolved& resolved() = 0;  // with the choices in place of "auto"
    virtual const Plan& plan() = 0;
    virtual std::string explanation() = 0;
    // Returns sentences for people about the data, the plan and, once a frame was drawn, about the
    // frame.
    virtual Warnings warnings() = 0;

    // Makes what a frame needs. draw() calls it if necessary.
    virtual void set_up() = 0;
    // Draws a frame, which is complete on return. Throws Interrupted once a stop is requested; the
    // next frame is then drawn from the start.
    virtual void draw(std::stop_token stop = {}) = 0;
    // Returns the last frame: associated, linear, before the background. It takes no memory if
    // `picture` has the frame's size.
    virtual void read(Image& picture) const = 0;
    // Adds times and counts of plan, set-up and last frame.
    virtual void add_to(FrameStatistics& statistics) = 0;
};

class Drawing;

// Draws a scene of method slice or project again and again while the scene changes. When a picture
// or a plan is next asked for, it repeats only the steps that the changes make necessary:
//
//   camera              the facts of the view and the plan; the renderer stays as long as the plan
//                       needs no other: no bricks, tables, uploads or programs
//   size                as camera, and a renderer of that size, which takes over everything that
//                       the size leaves: the volume's copy or textures, programs, a mesh's order
//   transfer function   also the facts of the data, and a renderer with its tables, which takes
//                       over as much; OpenGL compiles if the transfer function has another number
//                       of points or its tables have other sizes
//   clip                also the facts of the data, and a renderer, which takes over as much; a
//                       mesh is cut again
//   settings, choose_again()   as clip, and everything automatic is tried and chosen again
//
// Automatic values are chosen for the first picture and kept: resolved() has them written out. (A
// table grows if a view has longer segments than it knows.) A picture is, bit for bit on the engine
// `cpu`, that of a new renderer with that scene.
class SceneRenderer : public Frames {
  public:
    // `capabilities`: of the engine `cpu`, or of an OpenGL context that is current whenever the
    // renderer is called and when it ends (DrawContext::make_current()), and outlives it. Renderers
    // of several contexts may draw at the same time, each in a thread of its own. `share`: for
    // several renderers of one picture, on the engine `cpu`; all must be told of the same changes.
    // `tables`: several renderers may share them.
    SceneRenderer(Scene scene, std::shared_ptr<const VolumeData> volume,
                  const Capabilities& capabilities, OmissionSwitch omissions = {},
                  const PictureShare& share = {},
                  std::shared_ptr<TableCache> tables = std::make_shared<TableCache>());
    SceneRenderer(Scene scene, std::shared_ptr<const SceneMesh> mesh,
                  const Capabilities& capabilities, OmissionSwitch omissions = {},
                  std::shared_ptr<TableCache> tables = std::make_shared<TableCache>());
    ~SceneRenderer() override;
    SceneRenderer(const SceneRenderer&) = delete;
    SceneRenderer& operator=(const SceneRenderer&) = delete;

    void set_camera(const Camera& camera) override;
    void set_size(int width, int height) override;
    void set_transfer_function(const TransferFunction& transfer_function) override;
    void set_clip(const Clip& clip) override;
    void set_scene(Scene scene) override;
    void choose_again();
    // Lets choices take longer from now on if they make every frame quicker. Otherwise the time to
    // the first picture counts.
    void expect_many_frames();

    // Return the scene as asked for, with "auto"; and with the choices in its place.
    const Scene& scene() const override { return asked_; }
    const Resolved& resolved() override;
    // Throws Error if the data cannot be drawn as the scene asks, or the context cannot do it.
    const Plan& plan() override;
    std::string explanation() override;
    Warnings warnings() override;
    // For renderers that share a picture: the parts of the volume that they draw, in its index
    // space; and their numbers, nearer ones first.
    std::vector<IndexBox> shares();
    std::vector<int> front_to_back();
    const Capabilities& capabilities() const { return capabilities_; }

    void set_up() override;
    void draw(std::stop_token stop = {}) override;
    void read(Image& picture) const override;
    void add_to(FrameStatistics& statistics) override;
    Image picture() const;
    Image draw_picture() {
        draw();
        return picture();
    }

    // Returns the renderer, with the statistics of the last frame. It is set up if necessary.
    const FrameRenderer& renderer();
    // The last duration of each stage in milliseconds: "facts", "trials", "plan", "set_up".
    const std::map<std::string, double>& stages_ms() const { return stages_ms_; }

    // How often each stage was done, for tests.
    struct Counts {
        int data = 0, views = 0, trials = 0, plans = 0, renderers = 0;
        friend bool operator==(const Counts&, const Counts&) = default;
    };
    const Counts& counts() const { return counts_; }

  private:
    template <typename Change>
    void change(const Change& change_scene);
    void measure();

    Scene asked_;
    std::optional<Resolved> resolved_;
    Capabilities capabilities_;
    OmissionSwitch omissions_;
    std::unique_ptr<Drawing> drawing_;
    bool data_measured_ = false, view_measured_ = false, planned_ = false;
    bool many_frames_ = false;
    std::optional<Plan> plan_;
    bool renderer_fits_ = false;  // renderer_ has the scene's transfer function and size
    std::map<std::string, double> stages_ms_;
    Counts counts_;
};

}  // namespace lamina
