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
#include "plan/compositing_plan.h"
#include "executors/tree_leaves.h"

namespace lamina {

gl::Defines swizzle_defines(const CompositingPlan& plan);
gl::Defines colorize_defines(const CompositingPlan& plan);

// LaMar's exponent-factoring (2004, section 6): every node composites opacity in a fixed-point
// buffer, and its image goes through a dependent lookup into its parent's. One buffer a level is
// enough, because a node's image is used up at once.
class GlFixedTree {
  public:
    // `plan`: of the nodes. Leaves may be drawn in another way.
    GlFixedTree(const CompositingPlan& plan, const TreeShape& shape, const glm::vec3& single_color,
                int width, int height);

    int step_count() const { return static_cast<int>(shape_.leaf_count()); }
    // Replaces the target by the picture of the leaves. Ctrl-C ends it between them.
    void draw(TreeLeaves& leaves, gl::Framebuffer& target, Progress* progress);

  private:
    void evaluate(int level, const SampleSpan& node, TreeLeaves& leaves, Progress* progress);
    void put_into_parent(int level, const SampleSpan& child, const SampleSpan& node);

    CompositingPlan plan_;
    TreeShape shape_;
    gl::Program swizzle_, colorize_;
    gl::VertexArray no_attributes_;
    std::vector<gl::Framebuffer> buffers_;                 // by level
    std::map<std::pair<int, int>, gl::Texture> swizzles_;  // by samples of child and node
    int swizzled_ = 0;  // nodes of this frame: seeds of stochastic rounding
};

}  // namespace lamina
