// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "base/progress.h"
#include "lamina/image.h"
#include "plan/plan.h"
#include "scene/camera.h"

namespace lamina {

// Draws frames of one scene as its plan says: by slicing or projection, with OpenGL or on the CPU.
// Its constructor prepares the data and tables that all frames share.
class FrameRenderer {
  public:
    virtual ~FrameRenderer() = default;

    // Takes another plan of the same scene and size for further frames. Returns false, and changes
    // nothing, if that plan differs in more than belongs to one view.
    virtual bool take(const Plan& plan) = 0;
    // Draws a frame, which is complete on return. Ctrl-C ends it between steps; `progress` advances
    // by step_count() in all.
    virtual void draw(const View& view, Progress* progress = nullptr) = 0;
    virtual int step_count() const = 0;
    // Returns the last frame: associated, linear, before the background. The one with `image` takes
    // no memory if that has the frame's size.
    virtual void read(Image& image) const = 0;
    Image read() const {
        Image image;
        read(image);
        return image;
    }

    // Returns the durations of preparing and of the last frame, under the names that statistics
    // print.
    virtual std::map<std::string, double> stages_ms() const = 0;
    // Returns the number of fragments of the last frame; 0 with OpenGL, where queries count them.
    virtual std::int64_t fragments() const { return 0; }
    // Returns the host memory that the renderer takes beside the data; 0 with OpenGL, which has its
    // own memory.
    virtual std::int64_t byte_count() const { return 0; }
};

}  // namespace lamina
