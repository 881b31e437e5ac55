// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "base/client.h"
#include "compositing/tree_shape.h"
#include "gl/api.h"
#include "gl/framebuffer.h"
#include "gl/program.h"
#include "gl/sync.h"
#include "lamina/image.h"
#include "plan/compositing_plan.h"

namespace lamina {

// Texture formats of a plan's targets and nodes, and how OpenGL composites a fragment over another.

gl::TextureFormat color_format(const CompositingPlan& plan);    // RGBA of the target
gl::TextureFormat opacity_format(const CompositingPlan& plan);  // one channel of the same precision

// Defines the plan's codes, rounding and OVER for programs that round fragments by
// shaders/compositing.
void set_compositing(gl::Defines& defines, const CompositingPlan& plan);

// While this object lives, fragments are composited onto the bound target as the plan says.
class CompositingState {
  public:
    CompositingState(const CompositingPlan& plan, bool opacity_only);
    ~CompositingState();
    CompositingState(const CompositingState&) = delete;
    CompositingState& operator=(const CompositingState&) = delete;
};

// Draws leaves of a tree of fixed-point nodes. Samples (slabs, or tets) count from the nearest on.
class TreeLeaves {
  public:
    virtual ~TreeLeaves() = default;

    // Composites the opacity of samples onto the one channel of the bound target, in the plan's
    // order. `depth_scale` multiplies optical depths: the number of all samples over the leaf's.
    virtual void draw(const SampleSpan& span, double depth_scale) = 0;
};

// Composites by LaMar's exponent-factoring (2004, section 6) with OpenGL, as CpuFixedTree
// (executors/fixed_tree.h) does on the CPU, with a fixed-point image in place of each plane.
class GlTree {
  public:
    virtual ~GlTree() = default;
    GlTree(const GlTree&) = delete;
    GlTree& operator=(const GlTree&) = delete;

    int step_count() const { return static_cast<int>(shape_.leaf_count()); }

  protected:
    // `plan`: how nodes composite. Leaves may be drawn in another way.
    GlTree(const CompositingPlan& plan, const TreeShape& shape);

    // Makes the root's image. Ctrl-C ends it between leaves.
    void evaluate(Progress* progress);
    void bind_swizzle(const SampleSpan& child, const SampleSpan& node) const;

    static constexpr int child_unit = 6, swizzle_unit = 7;
    const CompositingPlan plan_;
    const TreeShape shape_;
    int inserted_nodes_ = 0;  // children composited in this frame, for stochastic rounding

  private:
    virtual void clear(int level) = 0;
    // `depth_scale` multiplies optical depths: the number of all samples over the leaf's.
    virtual void draw_leaf(int level, const SampleSpan& leaf, double depth_scale) = 0;
    // Composites a child, the image of the next level, onto its node's.
    virtual void put_into_parent(int level, const SampleSpan& child, const SampleSpan& node) = 0;
    void evaluate(int level, const SampleSpan& node, Progress* progress);

    std::map<std::pair<int, int>, gl::Texture> swizzles_;  // by samples of child and node
    gl::Fence leaf_;                                       // behind the last one
};

// Definitions of shaders/slicing/swizzle.frag.
gl::Defines swizzle_defines(const CompositingPlan& plan);

// A tree whose nodes the blending unit composites.
class GlFixedTree : public GlTree {
  public:
    GlFixedTree(const CompositingPlan& plan, const TreeShape& shape, const glm::vec3& single_color,
                int width, int height);

    // Sets the target to the picture of the leaves.
    void draw(TreeLeaves& leaves, gl::Framebuffer& target, Progress* progress);

  private:
    void clear(int level) override { image(level).clear(glm::vec4(0)); }
    void draw_leaf(int level, const SampleSpan& leaf, double depth_scale) override;
    void put_into_parent(int level, const SampleSpan& child, const SampleSpan& node) override;
    gl::Framebuffer& image(int level) { return images_[static_cast<std::size_t>(level)]; }

    gl::Program swizzle_, colorize_;
    gl::VertexArray no_attributes_;
    std::vector<gl::Framebuffer> images_;  // one for each level
    TreeLeaves* leaves_ = nullptr;         // of the frame
};

}  // namespace lamina
