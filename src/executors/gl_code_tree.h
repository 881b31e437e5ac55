// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "executors/gl_compositing.h"
#include "executors/gl_pixels.h"

namespace lamina {

// Draws leaves of a GlCodeTree. Samples (slabs, or tets) count from the nearest on.
class CodeLeaves {
  public:
    virtual ~CodeLeaves() = default;

    // Composites the opacity of samples, a word a pixel, onto an image that is clear, in the plan's
    // order. `depth_scale` multiplies optical depths: the number of all samples over the leaf's.
    virtual void draw(const SampleSpan& span, const GlPixels& opacity, double depth_scale) = 0;
};

// Definitions of shaders/slicing/swizzle.comp and colorize.comp.
gl::Defines code_tree_defines(const CompositingPlan& plan);

// A tree whose nodes compute shaders composite on codes, as render.emulate says or, without it,
// rounded to the nearest code.
class GlCodeTree : public GlTree {
  public:
    GlCodeTree(const CompositingPlan& plan, const TreeShape& shape, const glm::vec3& single_color,
               int width, int height);

    // Sets the picture to that of the leaves.
    void draw(CodeLeaves& leaves, const GlPixels& picture, Progress* progress);

  private:
    void clear(int level) override { image(level).clear(); }
    void draw_leaf(int level, const SampleSpan& leaf, double depth_scale) override;
    void put_into_parent(int level, const SampleSpan& child, const SampleSpan& node) override;
    GlPixels& image(int level) { return images_[static_cast<std::size_t>(level)]; }

    int width_, height_;
    gl::Program swizzle_, colorize_;
    std::vector<GlPixels> images_;  // opacity, a word a pixel, one image for each level
    CodeLeaves* leaves_ = nullptr;  // of the frame
};

}  // namespace lamina
