// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stop_token>
#include <string>

#include "lamina/frame_statistics.h"
#include "lamina/image.h"
#include "lamina/scene.h"
#include "plan/plan.h"
#include "render/resolved.h"
#include "render/warnings.h"

namespace lamina {

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

}  // namespace lamina
