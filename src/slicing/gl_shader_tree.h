// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "base/client.h"
#include "compositing/tree_shape.h"
#include "gl/api.h"
#include "gl/framebuffer.h"
#include "slicing/gl_slab_source.h"

namespace lamina {

// The node whose result a program of the tree writes: an inner one or the root.
enum class NodePlace { inner, root };
// Return the definitions that specialise slicing/leaf.frag and slicing/node.frag for a plan.
// `segments`: the result of segment_defines().
gl::Defines leaf_defines(const SlicePlan& plan, gl::Defines segments, NodePlace place);
gl::Defines node_defines(const SlicePlan& plan, NodePlace place);

// Draws a compositing tree whose nodes shaders compute in float, with colour (docs/numerics.md,
// section 4). Leaves march their slabs; inner nodes read their children from layers of array
// textures. The picture is made in bands of rows, a complete tree each, so that images are small.
class GlShaderTree {
  public:
    // `source` and `plan` must outlive the tree. Throws Error if a level's images do not fit.
    GlShaderTree(const GlSlabSource& source, const SlicePlan& plan,
                 const Capabilities& capabilities, int width, int height);

    int step_count() const { return bands() * leaf_count_; }  // steps that draw() reports
    // Must be called after source and plan have changed in what belongs to one view alone.
    void take_plan();
    void set_view(const View& view, const Slabs& slabs);
    // Replaces the target by the picture. Ctrl-C ends it between leaves.
    void draw(gl::Framebuffer& target, Progress* progress);

  private:
    // The images of the children of one node of a level, nearest first.
    struct LevelImages {
        gl::Texture color;
        std::optional<gl::Texture> alpha;
    };
    // A band of rows of the target; row 0 is at the bottom, as in OpenGL.
    struct Band {
        int first_row, rows;
    };
    // The triangles of a leaf in one brick.
    struct LeafDraw {
        std::size_t brick;
        std::size_t first_vertex, end_vertex;
    };

    int count_leaves(int level, const SampleSpan& node) const;
    int bands() const { return (height_ + band_rows_ - 1) / band_rows_; }
    // Chooses the rows of a band: few enough for image_budget and for the plan's batches.
    void choose_bands(const Capabilities& capabilities, std::int64_t layers, int most_layers);
    NodePlace leaf_place() const { return images_.empty() ? NodePlace::root : NodePlace::inner; }
    void make_programs();
    gl::Program make_program(const char* fragment, const gl::Defines& defines);

    void add_leaves(int level, const SampleSpan& node);
    void evaluate(int level, const SampleSpan& node, int layer);
    void draw_leaf(const SampleSpan& leaf, int level, int layer);
    void march(gl::Program& program, std::size_t leaf);
    // Binds a node's output, and clears it unless it is the target, which draw()'s caller cleared.
    void bind_output(int level, int layer);

    const GlSlabSource& source_;
    const SlicePlan& plan_;
    TreeShape shape_;
    int width_, height_, band_rows_ = 0, leaf_count_ = 0;
    gl::Defines defines_;  // of the leaves' program
    std::optional<gl::Program> leaf_, node_, root_node_, encode_;
    std::vector<LevelImages> images_;     // by level of the node whose children they hold
    std::optional<gl::Framebuffer> sum_;  // sum of a leaf over several bricks
    gl::LayerFramebuffer layer_;
    gl::VertexArray vertex_array_, no_attributes_;
    gl::Buffer vertices_;
    // The following belong to the view and are kept from frame to frame.
    std::optional<View> view_;
    Slabs slabs_;
    std::vector<SlabVertex> triangles_;
    std::vector<std::size_t> bricks_;   // nearest first
    std::vector<LeafDraw> leaf_draws_;  // draws of all leaves, nearest first, brick by brick
    // The following belong to the frame.
    gl::Framebuffer* target_ = nullptr;
    Progress* progress_ = nullptr;
    Band band_{0, 0};
    std::size_t next_leaf_ = 0;
};

}  // namespace lamina
