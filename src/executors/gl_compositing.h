// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gl/framebuffer.h"
#include "gl/program.h"
#include "lamina/image.h"
#include "plan/compositing_plan.h"

namespace lamina {

// Texture formats of the targets and nodes of a plan, and how OpenGL composites one fragment over
// another.

gl::TextureFormat color_format(const CompositingPlan& plan);    // RGBA of the target
gl::TextureFormat opacity_format(const CompositingPlan& plan);  // one channel of the same precision

// Sets the definitions of the plan's codes, rounding and OVER for shaders/compositing in programs
// that round fragments to codes. A program that must read its target reads it at texture unit
// `target_unit`.
void set_compositing(gl::Defines& defines, const CompositingPlan& plan);
inline constexpr int target_unit = 5;

// While this object lives, fragments are composited onto the bound target as the plan says.
class CompositingState {
  public:
    CompositingState(const CompositingPlan& plan, bool opacity_only, const gl::Framebuffer& target);
    ~CompositingState();
    CompositingState(const CompositingState&) = delete;
    CompositingState& operator=(const CompositingState&) = delete;

  private:
    bool native_;
};

// Decodes a picture that the program stored as codes of n bits in 8 or 16 bits: code / (2^n - 1).
void decode(Image& image, const CompositingPlan& plan);

// Must be called between draws that may cover the same pixel. It waits, if needed, until the result
// of the first draw can be read.
void finish_layer(const CompositingPlan& plan);

}  // namespace lamina
