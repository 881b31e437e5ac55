// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "base/progress.h"
#include "compositing/tree_shape.h"
#include "executors/tree_leaves.h"
#include "gl/buffer.h"
#include "gl/framebuffer.h"
#include "gl/program.h"
#include "plan/compositing_plan.h"

namespace lamina {

gl::Defines swizzle_defines(const CompositingPlan& plan);
gl::Defines colorize_defines(const CompositingPlan& plan);

// LaMar's exponent-factoring (2004, section 6). Every node composites opacity in a fixed-point
// buffer, and its image goes through a dependent lookup into the buffer of its parent. One buffer a
// level is enough, because a node's image is used up at once.
class GlFixedTree {
  public:
    // `plan`: how the nodes composite. Leaves may be drawn in another way.
    GlFixedTree(const CompositingPlan& plan, const TreeShape& shape, const glm::vec3& single_color,
                int width, int height);

    int step_count() const { return static_cast<int>(shape_.leaf_count()); }
    // Replaces the target by the picture of the leaves. Ctrl-C ends it between leaves.
    void draw(TreeLeaves& leaves, gl::Framebuffer& target, Progress* progress);

  private:
    void evaluate(int level, const SampleSpan& node, TreeLeaves& leaves, Progress* progress);
    void put_into_parent(int level, const SampleSpan& child, const SampleSpan& node);

    CompositingPlan plan_;
    TreeShape shape_;
    gl::Program swizzle_, colorize_;
    gl::VertexArray no_attributes_;
    std::vector<gl::Framebuffer> buffers_;                 // one for each level
    std::map<std::pair<int, int>, gl::Texture> swizzles_;  // by samples of child and node
    int swizzled_ = 0;  // number of nodes in this frame so far, which seeds stochastic rounding
};

}  // namespace lamina
