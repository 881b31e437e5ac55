// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "base/progress.h"
#include "compositing/tree_shape.h"
#include "gl/framebuffer.h"
#include "gl/program.h"
#include "gl/vertex_array.h"
#include "slicing/gl_slab_pass.h"

namespace lamina {

gl::Defines swizzle_defines(const SlicePlan& plan);
gl::Defines colorize_defines(const SlicePlan& plan);

// LaMar's exponent-factoring (2004, section 6): every node composites opacity in a fixed-point
// buffer, and its image goes through a dependent lookup into its parent's. One buffer a level is
// enough, because a node's image is used up at once.
class GlFixedTree {
  public:
    // `source` and `plan` must outlive it.
    GlFixedTree(const GlSlabSource& source, const SlicePlan& plan, int width, int height);

    int step_count() const { return static_cast<int>(shape_.leaf_count()); }
    void set_view(const View& view, const Slabs& slabs) { leaves_.set_view(view, slabs); }
    // Replaces the target by the picture. Ctrl-C ends it between leaves.
    void draw(gl::Framebuffer& target, Progress* progress);

  private:
    void make_swizzles(int level, const SampleSpan& node);
    void evaluate(int level, const SampleSpan& node, Progress* progress);
    void put_into_parent(int level, const SampleSpan& child, const SampleSpan& node);

    const GlSlabSource& source_;
    const SlicePlan& plan_;
    TreeShape shape_;
    GlSlabPass leaves_;
    gl::Program swizzle_, colorize_;
    gl::VertexArray no_attributes_;
    std::vector<gl::Framebuffer> buffers_;                 // by level
    std::map<std::pair<int, int>, gl::Texture> swizzles_;  // by samples of child and node
    int swizzled_ = 0;  // nodes of this frame: seeds of stochastic rounding
};

}  // namespace lamina
