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

// What draws frames of one scene as its plan says: slicing or projection, with OpenGL or with the
// native engine. Whoever makes one prepares data and tables for all frames.
class FrameRenderer {
  public:
    virtual ~FrameRenderer() = default;

    // Draws further frames by another plan of the same scene and size. False where that differs in
    // more than belongs to one view: then nothing changes.
    virtual bool take(const Plan& plan) = 0;
    // Complete when it returns. Ctrl-C ends it between steps; `progress` advances by step_count()
    // in all.
    virtual void draw(const View& view, Progress* progress = nullptr) = 0;
    virtual int step_count() const = 0;
    // The last frame: associated, linear, before the background. The first takes no memory where
    // `image` has its size.
    virtual void read(Image& image) const = 0;
    Image read() const {
        Image image;
        read(image);
        return image;
    }

    // What took how long, by the names of the statistics: of preparing, or of the last frame.
    virtual std::map<std::string, double> stages_ms() const = 0;
    // Of the last frame; 0 where OpenGL's queries count them.
    virtual std::int64_t fragments() const { return 0; }
    // Host memory taken beside the data itself; 0 where it is OpenGL's.
    virtual std::int64_t byte_count() const { return 0; }
};

}  // namespace lamina
