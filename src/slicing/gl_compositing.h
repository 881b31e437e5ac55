// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gl/framebuffer.h"
#include "gl/program.h"
#include "scene/plan.h"

namespace lamina {

// What targets and nodes of a plan hold, and how one fragment is put over another.

gl::TextureFormat color_format(const SlicePlan& plan);    // RGBA of the target
gl::TextureFormat opacity_format(const SlicePlan& plan);  // one channel of the same precision

// Codes, rounding and OVER of the plan, for shaders/compositing. A program that composites reads
// its target at texture unit `target_unit` where it must.
void set_compositing(gl::Defines& defines, const SlicePlan& plan);
inline constexpr int target_unit = 5;

// From its making to its end, fragments are composited onto the bound target as the plan says.
class CompositingState {
  public:
    CompositingState(const SlicePlan& plan, bool opacity_only, const gl::Framebuffer& target);
    ~CompositingState();
    CompositingState(const CompositingState&) = delete;
    CompositingState& operator=(const CompositingState&) = delete;

  private:
    bool native_;
};

// Between draws that may cover one pixel twice: waits until the first can be read, where needed.
void finish_layer(const SlicePlan& plan);

}  // namespace lamina
