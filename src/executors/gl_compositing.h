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
#include "lamina/image.h"
#include "plan/compositing_plan.h"

namespace lamina {

// Texture formats of a plan's targets and nodes, and how OpenGL composites a fragment over another.

gl::TextureFormat color_format(const CompositingPlan& plan);    // RGBA of the target
gl::TextureFormat opacity_format(const CompositingPlan& plan);  // one channel of the same precision

// Defines the plan's codes, rounding and OVER for programs that round fragments by
// shaders/compositing. A program that must read its target reads it at unit `target_unit`.
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

// Must be called between draws that may cover the same pixel; makes what was drawn readable.
void finish_layer(const CompositingPlan& plan);

// Draws leaves of a tree of fixed-point nodes. Samples (slabs, or tets) count from the nearest on.
class TreeLeaves {
  public:
    virtual ~TreeLeaves() = default;

    // Composites the opacity of samples onto the one channel of the bound target, in the plan's
    // order. `depth_scale` multiplies optical depths: the number of all samples over the leaf's.
    virtual void draw(const SampleSpan& span, const gl::Framebuffer& target,
                      double depth_scale) = 0;
};

// Return the definitions of shaders/slicing/swizzle.frag and colorize.frag.
gl::Defines swizzle_defines(const CompositingPlan& plan);
gl::Defines colorize_defines(const CompositingPlan& plan);

// Composites by LaMar's exponent-factoring (2004, section 6) with OpenGL, as CpuFixedTree
// (executors/fixed_tree.h) does on the CPU, with a fixed-point buffer in place of each plane.
class GlFixedTree {
  public:
    // `plan`: how nodes composite. Leaves may be drawn in another way.
    GlFixedTree(const CompositingPlan& plan, const TreeShape& shape, const glm::vec3& single_color,
                int width, int height);

    int step_count() const { return static_cast<int>(shape_.leaf_count()); }
    // Sets the target to the picture of the leaves. Ctrl-C ends it between leaves.
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
    int inserted_nodes_ = 0;  // children composited in this frame, for stochastic rounding
};

}  // namespace lamina
