// SPDX-License-Identifier: Apache-2.0
#pragma once

// Draws one scene and its data from the first picture to the last. A SceneRenderer draws all
// pictures but those of the reference tracers.

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

// The share of a volume that one renderer draws, if several draw one picture together.
struct PictureShare {
    int number = 0;  // 0 .. count - 1
    int count = 1;
};

// Returns the keys that are automatic and that the scene's method needs. Tables are not among them:
// they are chosen with each view. Nor is the order of tets, which stays automatic if the scene has
// a tree, whose leaves take tets from all over the mesh, or if tets overlap (orders_slowly()).
std::vector<std::string> open_keys(const Scene& scene);

// A scene in which everything that its method needs is chosen: open_keys() is empty. Only a Drawing
// makes one, from a plan. Later views are planned and drawn from it.
class Resolved {
  public:
    explicit Resolved(Scene scene);

    const Scene& scene() const { return scene_; }
    // Calls change_scene(scene), which must make nothing automatic.
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
    // By default these call set_scene(); derived classes may keep more.
    virtual void set_size(int width, int height);
    virtual void set_transfer_function(const TransferFunction& transfer_function);
    virtual void set_clip(const Clip& clip);

    virtual const Resolved& resolved() = 0;  // with the choices in place of "auto"
    virtual const Plan& plan() = 0;
    virtual std::string explanation() = 0;
    // Returns warnings about the data, the plan and, once a frame is drawn, about the frame.
    virtual Warnings warnings() = 0;

    // Makes what a frame needs. draw() calls it if necessary.
    virtual void set_up() = 0;
    // Draws a frame, which is complete on return. Throws Interrupted once a stop is requested; the
    // next frame is then drawn from the start.
    virtual void draw(std::stop_token stop = {}) = 0;
    // Copies the last frame to `picture`: associated colours, before the background. Allocates
    // nothing if `picture` has the frame's size.
    virtual void read(Image& picture) const = 0;
    // Adds times and counts of the plan, the set-up and the last frame.
    virtual void add_to(FrameStatistics& statistics) = 0;
};

class Drawing;

// Draws a scene of method slice or project again and again while the scene changes. When a picture
// or a plan is next asked for, it repeats only the steps that the changes make necessary:
//
//   camera              the facts of the view and the plan; the renderer stays as long as the plan
//                       needs no other: no bricks, tables, uploads or programs. Rays are sampled
//                       for the view by the cpu engine (of volumes), and if a table may be needed
//                       that no plan has chosen; OpenGL keeps what rays of the first view met
//   size                as camera, and a renderer of that size, which takes over everything that
//                       the size leaves: the volume's copy or textures, programs, a mesh's order
//   transfer function   also the facts of the data, and a renderer with its tables, which takes
//                       over as much; OpenGL compiles if the transfer function has another number
//                       of points or its tables have other sizes
//   clip                also the facts of the data, and a renderer, which takes over as much; a
//                       mesh is cut again
//   settings, choose_again()   as clip, and everything automatic is tried and chosen again
//
// Automatic values are chosen for the first picture and kept: resolved() has them. (A table grows
// if a view has longer segments than the table covers.) A picture is equal to that of a new
// renderer with the resolved scene, bit for bit on the cpu engine.
class SceneRenderer : public Frames {
  public:
    // `capabilities`: those of the cpu engine, or of an OpenGL context, which must be current (see
    // DrawContext::make_current()) in every call and in the destructor. Renderers of different
    // contexts may draw at the same time in different threads. `share`: set if several renderers
    // draw one picture, with the cpu engine; all of them must get the same changes. `tables`: may
    // be shared by renderers.
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
    // Allows choices to take longer from now on if that makes every frame faster. Otherwise the
    // time to the first picture counts.
    void expect_many_frames();

    // scene() returns the scene as it was given, with its "auto"; resolved(), with choices instead.
    const Scene& scene() const override { return asked_; }
    const Resolved& resolved() override;
    // Throws Error if the data cannot be drawn as the scene asks, or the context cannot do it.
    const Plan& plan() override;
    std::string explanation() override;
    Warnings warnings() override;
    // If several renderers share a picture: shares() returns the box of the volume, in index space,
    // that each of them draws, and front_to_back() returns their numbers, the nearest first.
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

    // Numbers of times that each stage was done, for tests.
    struct Counts {
        int data = 0, views = 0, trials = 0, plans = 0, renderers = 0;
        int rays = 0;  // views whose rays were sampled
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
    bool renderer_fits_ = false;  // the renderer matches transfer function, size and clip
    std::map<std::string, double> stages_ms_;
    Counts counts_;
};

}  // namespace lamina
