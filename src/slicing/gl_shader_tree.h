// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "base/client.h"
#include "compositing/tree_shape.h"
#include "gl/api.h"
#include "gl/framebuffer.h"
#include "slicing/gl_slab_source.h"

namespace lamina {

// The place of the node whose output a program of the tree writes: an inner node or the root.
enum class NodePlace { inner, root };
gl::Defines leaf_defines(const SlicePlan& plan, gl::Defines segments, NodePlace place);
gl::Defines node_defines(const SlicePlan& plan, NodePlace place);

// A compositing tree whose nodes are computed in programs, in float and with colour
// (docs/numerics.md, section 4). Leaves march their slabs; inner nodes read their children from
// layers of array textures. The picture is made in bands of rows, one whole tree after the other,
// so that the images of a level need only the size of a band.
class GlShaderTree {
  public:
    // `source` and `plan` must outlive the tree. Throws Error if a level's images do not fit.
    GlShaderTree(const GlSlabSource& source, const SlicePlan& plan,
                 const Capabilities& capabilities, int width, int height);

    int step_count() const { return bands() * leaf_count_; }  // steps of the progress
    // Must be called after source and plan have changed in what belongs to one view alone. It makes
    // other programs if the plan needs them.
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
    // Some rows of the target; row 0 is at the bottom, as in OpenGL.
    struct Band {
        int first_row, rows;
    };
    struct LeafDraw {
        std::size_t brick;
        std::size_t first_vertex, end_vertex;
    };

    int count_leaves(int level, const SampleSpan& node) const;
    int bands() const { return (height_ + band_rows_ - 1) / band_rows_; }
    void choose_bands(const Capabilities& capabilities, std::int64_t layers, int most_layers);
    NodePlace leaf_place() const { return images_.empty() ? NodePlace::root : NodePlace::inner; }
    void make_programs();
    gl::Program make_program(const char* fragment, const gl::Defines& defines);

    void add_leaves(int level, const SampleSpan& node);
    void evaluate(int level, const SampleSpan& node, int layer);
    void draw_leaf(const SampleSpan& leaf, int level, int layer);
    void march(gl::Program& program, std::size_t leaf);
    // Binds the output of a node of a level and clears it. The root's picture is cleared only once.
    void bind_output(int level, int layer);

    const GlSlabSource& source_;
    const SlicePlan& plan_;
    TreeShape shape_;
    int width_, height_, band_rows_ = 0, leaf_count_ = 0;
    gl::Defines defines_;  // of the leaves' program
    std::optional<gl::Program> leaf_, node_, root_node_, encode_;
    std::vector<LevelImages> images_;     // images of the children of inner nodes, by level
    std::optional<gl::Framebuffer> sum_;  // result of a leaf that spans several bricks
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
