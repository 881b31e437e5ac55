// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "executors/gl_compositing.h"
#include "gl/timeline.h"
#include "slicing/gl_march.h"
#include "slicing/slice_renderer.h"

namespace lamina {

// Returns the definitions that specialise slicing/slab.frag; `segments`: from segment_defines().
gl::Defines slab_defines(const SlicePlan& plan, gl::Defines segments);

// Composites slab after slab onto a target: all slabs for the picture, or those of a leaf of a tree
// of fixed-point nodes. For a leaf it composites opacity alone, in one channel.
class GlSlabPass : public TreeLeaves {
  public:
    // `source` and `plan` must outlive the pass.
    GlSlabPass(const GlSlabSource& source, const SlicePlan& plan, int image_height);

    // Must be called after source and plan have changed in what belongs to one view alone.
    void take_plan();
    void set_view(const View& view, const Slabs& slabs);
    // Composites slabs onto the bound target, in the plan's order. `depth_scale`: 1 or, for a leaf,
    // the number of all samples of the ray over that of the leaf.
    void draw(const SampleSpan& span, double depth_scale) override;

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
    std::vector<std::size_t> starts_;  // by brick: `starts` of append_slab_polygons()
};

// Draws a volume (gl_slice_renderer.cpp) in the current OpenGL context, which must outlive it.
class GlSliceRenderer : public SliceRenderer {
  public:
    // Uploads the volume, builds the tables and compiles programs; errors of OpenGL are Errors.
    // `ready`: volume() of another renderer, which is used if it has the right form.
    GlSliceRenderer(const Volume& volume, const TransferFunction& transfer_function,
                    const Facts& facts, const SlicePlan& plan, const Capabilities& capabilities,
                    int width, int height, std::shared_ptr<const GlVolume> ready = nullptr);
    GlSliceRenderer(const GlSliceRenderer&) = delete;  // its parts refer to its plan
    GlSliceRenderer& operator=(const GlSliceRenderer&) = delete;

    bool try_switch_to(const Plan& plan) override;
    void draw(const View& view, Progress* progress = nullptr) override;
    int step_count() const override;
    using FrameRenderer::read;
    void read(Image& image) const override;
    std::map<std::string, double> stages_ms() const override;

    SliceReuse reusable() const override { return {nullptr, volume()}; }
    std::shared_ptr<const GlVolume> volume() const { return source_ ? source_->volume() : kept_; }

  private:
    void draw_straight(Progress* progress);

    SlicePlan plan_;
    Grid grid_;
    // Empty if nothing is visible, except for target_. Otherwise the picture is marched_, or slabs_
    // are blended onto target_ or are the leaves of fixed_tree_.
    std::optional<gl::Framebuffer> target_;
    std::optional<GlSlabSource> source_;
    std::optional<GlSlabPass> slabs_;
    std::optional<GlFixedTree> fixed_tree_;
    std::unique_ptr<GlMarchedPicture> marched_;
    gl::Timeline timeline_;
    std::shared_ptr<const GlVolume> kept_;  // for another renderer, if nothing is visible
    double geometry_ms_ = 0, draw_ms_ = 0;  // of the last frame
};

}  // namespace lamina
