// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "compositing/tree_shape.h"
#include "gl/framebuffer.h"

namespace lamina {

// What a tree of fixed-point nodes is made of: samples in the order of visibility, 0 nearest the
// eye.
class TreeLeaves {
  public:
    virtual ~TreeLeaves() = default;

    // Composites the opacity of these samples onto the target, which is bound, in its one channel
    // and in the plan's order. Optical depths are multiplied by `depth_scale`: all samples over
    // those of the leaf.
    virtual void draw(const SampleSpan& span, const gl::Framebuffer& target,
                      double depth_scale) = 0;
};

}  // namespace lamina
