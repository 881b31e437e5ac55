// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "executors/tree_leaves.h"
#include "gl/buffer.h"
#include "gl/framebuffer.h"
#include "gl/program.h"
#include "slicing/gl_slab_source.h"

namespace lamina {

// Returns the definitions that specialise slicing/slab.frag, added to those of its segments.
gl::Defines slab_defines(const SlicePlan& plan, gl::Defines segments);

// Composites slab after slab onto a target: a whole picture, or a leaf of a tree of fixed-point
// nodes. For a leaf it composites opacity alone, in one channel.
class GlSlabPass : public TreeLeaves {
  public:
    // `source` and `plan` must outlive the pass.
    GlSlabPass(const GlSlabSource& source, const SlicePlan& plan, int image_height);

    // Must be called after source and plan have changed in what belongs to one view alone. It makes
    // another program if the plan needs one.
    void take_plan();
    void set_view(const View& view, const Slabs& slabs);
    // Composites slabs onto the target, in the plan's order. `depth_scale`: for a leaf, the number
    // of all samples of the ray over that of the leaf.
    void draw(const SampleSpan& span, const gl::Framebuffer& target, double depth_scale) override;

  private:
    void set_up_program();
    void draw_brick(std::size_t place, const SampleSpan& span);

    const GlSlabSource& source_;
    const SlicePlan& plan_;
    int image_height_;
    gl::Defines defines_;  // of the program
    gl::Program program_;
    gl::Texture ranks_;  // ranks of dithering
    gl::VertexArray vertex_array_;
    gl::Buffer vertices_;
    // The following belong to the view and are kept from frame to frame.
    std::optional<View> view_;
    Slabs slabs_;
    std::vector<SlabVertex> triangles_;
    std::vector<std::size_t> bricks_;  // in drawing order
    std::vector<std::size_t> starts_;  // slabs + 1 for each brick: see append_slab_polygons()
};

// Uploads vertices for the attributes 0 (position) and 1 (slab). If they do not fit, the buffer
// grows.
void upload_vertices(const std::vector<SlabVertex>& triangles, gl::Buffer& buffer,
                     gl::VertexArray& vertex_array);

}  // namespace lamina
