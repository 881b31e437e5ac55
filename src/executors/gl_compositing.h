// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gl/framebuffer.h"
#include "gl/program.h"
#include "lamina/image.h"
#include "plan/compositing_plan.h"

namespace lamina {

// What targets and nodes of a plan hold, and how one fragment is put over another.

gl::TextureFormat color_format(const CompositingPlan& plan);    // RGBA of the target
gl::TextureFormat opacity_format(const CompositingPlan& plan);  // one channel of the same precision

// Codes, rounding and OVER of the plan, for shaders/compositing, in programs that round fragments
// to codes. A program that composites reads its target at texture unit `target_unit` where it must.
void set_compositing(gl::Defines& defines, const CompositingPlan& plan);
inline constexpr int target_unit = 5;

// From its making to its end, fragments are composited onto the bound target as the plan says.
class CompositingState {
  public:
    CompositingState(const CompositingPlan& plan, bool opacity_only, const gl::Framebuffer& target);
    ~CompositingState();
    CompositingState(const CompositingState&) = delete;
    CompositingState& operator=(const CompositingState&) = delete;

  private:
    bool native_;
};

// A picture of a target in which the program stored codes of n bits in 8 or 16: code / (2^n - 1).
void decode(Image& image, const CompositingPlan& plan);

// Between draws that may cover one pixel twice: waits until the first can be read, where needed.
void finish_layer(const CompositingPlan& plan);

}  // namespace lamina
