// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "compositing/tree_shape.h"
#include "gl/framebuffer.h"

namespace lamina {

// The samples of a tree of fixed-point nodes. They are numbered in visibility order; 0 is the
// nearest to the eye.
class TreeLeaves {
  public:
    virtual ~TreeLeaves() = default;

    // Composites the opacity of these samples onto the one channel of the bound target, in the
    // plan's order. Optical depths are multiplied by `depth_scale`, the number of all samples over
    // that of the leaf.
    virtual void draw(const SampleSpan& span, const gl::Framebuffer& target,
                      double depth_scale) = 0;
};

}  // namespace lamina
