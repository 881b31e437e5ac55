// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/client.h"
#include "compositing/tree_shape.h"
#include "executors/gl_pixels.h"
#include "gl/api.h"
#include "gl/program.h"
#include "gl/sync.h"
#include "plan/capabilities.h"
#include "slicing/gl_march.h"
#include "slicing/gl_slab_source.h"

namespace lamina {

// The node whose result a program of the tree writes: an inner one or the root.
enum class NodePlace { inner, root };
// Return the definitions that specialise slicing/leaf.comp and slicing/node.comp for a plan.
// `segments`: the result of segment_defines().
gl::Defines leaf_defines(const SlicePlan& plan, gl::Defines segments, NodePlace place);
gl::Defines node_defines(const SlicePlan& plan, NodePlace place);

// Draws a compositing tree whose nodes compute shaders compute in float, with colour
// (docs/numerics.md, section 4). Leaves march their slabs; inner nodes read their children from
// buffers. The picture is made in bands of rows, a complete tree each, so that buffers are small.
class GlShaderTree : public GlMarchedPicture {
  public:
    // `source` and `plan` must outlive the tree. Throws Error if a level's nodes do not fit.
    GlShaderTree(const GlSlabSource& source, const SlicePlan& plan,
                 const Capabilities& capabilities, int width, int height);

    int step_count() const override { return height_ * leaf_count_; }  // rows of leaves
    void take_plan() override;
    void set_view(const View& view, const Slabs& slabs) override;
    void clear() override { picture_.clear(); }
    void draw(Progress* progress) override;
    void end_frame() override { pace_->end_frame(); }
    void read(Image& image) const override;

  private:
    int count_leaves(int level, const SampleSpan& node) const;
    // Chooses the rows of a band: few enough for memory_budget, for the largest storage block and
    // for the plan's batches. `level_nodes`: largest number of children of a node, by level.
    void choose_bands(const Capabilities& capabilities, const std::vector<int>& level_nodes);
    NodePlace leaf_place() const { return levels_.empty() ? NodePlace::root : NodePlace::inner; }
    std::int64_t node_row_words() const;
    std::int64_t node_words() const { return node_row_words() * band_rows_; }
    void make_programs();

    void evaluate(int level, const SampleSpan& node, int place);
    void draw_leaf(const SampleSpan& leaf, int level, int place);
    // Makes the program write the node that is number `place` among its parent's children.
    void bind_output(gl::Program& program, int level, int place, const SampleSpan& node);

    const GlSlabSource& source_;
    const SlicePlan& plan_;
    TreeShape shape_;
    int width_, height_, band_rows_ = 0, leaf_count_ = 0;
    gl::Defines defines_;  // of the leaves' program
    std::optional<gl::Program> leaf_, node_, root_node_;
    GlMarch march_;
    GlPixels picture_;
    std::optional<gl::WorkPace> pace_;
    std::vector<gl::Buffer> levels_;  // by level: the children of one node, nearest first
    std::optional<gl::Buffer> kept_;  // what rays have passed between two dispatches of a leaf
    // The following belong to the frame.
    Progress* progress_ = nullptr;
    gl::Fence drawn_;  // behind the last leaf
    RowBand band_;
};

}  // namespace lamina
