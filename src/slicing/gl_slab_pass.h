// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "executors/tree_leaves.h"
#include "gl/buffer.h"
#include "gl/framebuffer.h"
#include "gl/program.h"
#include "gl/vertex_array.h"
#include "slicing/gl_slab_source.h"

namespace lamina {

// What slicing/slab.frag is specialised by, on top of its segments.
gl::Defines slab_defines(const SlicePlan& plan, gl::Defines segments);

// Composites slab after slab onto a target: a whole picture, or a leaf of a tree of fixed-point
// nodes (then opacity alone, in one channel).
class GlSlabPass : public TreeLeaves {
  public:
    // `source` and `plan` must outlive it.
    GlSlabPass(const GlSlabSource& source, const SlicePlan& plan, int image_height);

    // After source and plan have changed in what belongs to one view alone: makes another program
    // where that needs one.
    void take_plan();
    void set_view(const View& view, const Slabs& slabs);
    // Onto the target, in the plan's order. `depth_scale`: of a leaf, samples of the ray over its
    // own.
    void draw(const SampleSpan& span, const gl::Framebuffer& target, double depth_scale) override;

  private:
    void set_up_program();
    void draw_brick(std::size_t place, const SampleSpan& span);

    const GlSlabSource& source_;
    const SlicePlan& plan_;
    int image_height_;
    gl::Defines defines_;  // of the program
    gl::Program program_;
    gl::Texture ranks_;  // of dithering
    gl::VertexArray vertex_array_;
    gl::Buffer vertices_;
    // Of the view; kept from frame to frame.
    std::optional<View> view_;
    Slabs slabs_;
    std::vector<SlabVertex> triangles_;
    std::vector<std::size_t> bricks_;  // in the order drawn
    std::vector<std::size_t> starts_;  // slabs + 1 of each: see append_slab_polygons()
};

// Uploads vertices for attributes 0 (position) and 1 (slab), into a larger buffer where they do not
// fit.
void upload_vertices(const std::vector<SlabVertex>& triangles, gl::Buffer& buffer,
                     gl::VertexArray& vertex_array);

}  // namespace lamina
