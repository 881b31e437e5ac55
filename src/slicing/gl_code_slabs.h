// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/client.h"
#include "executors/gl_code_tree.h"
#include "executors/gl_pixels.h"
#include "gl/sync.h"
#include "gl/texture.h"
#include "plan/capabilities.h"
#include "slicing/gl_march.h"

namespace lamina {

// Returns the ranks of dithering as shaders/slicing/dither_ranks.glsl reads them.
gl::Texture upload_ranks(const Dither& dither);
inline constexpr int ranks_unit = GlSlabSource::first_free_unit;

// Draws slabs for Target::emulated: a compute shader composites each ray's slabs on codes, in
// registers: all of them, or those of a leaf of a tree. Pictures are made in bands of rows.
class GlCodeSlabs : public GlMarchedPicture, private CodeLeaves {
  public:
    // `source` and `plan` must outlive the object.
    GlCodeSlabs(const GlSlabSource& source, const SlicePlan& plan, const Capabilities& capabilities,
                int width, int height);

    // Rows, or leaves of a tree.
    int step_count() const override { return tree_ ? tree_->step_count() : height_; }
    void take_plan() override;
    void set_view(const View& view, const Slabs& slabs) override;
    void clear() override { picture_.clear(); }
    void draw(Progress* progress) override;
    void end_frame() override { pace_.end_frame(); }
    void read(Image& image) const override;

  private:
    gl::Defines wanted_defines() const;
    void draw(const SampleSpan& span, const GlPixels& opacity, double depth_scale) override;
    void draw_slabs(const SampleSpan& span, const GlPixels& picture, Progress* progress);

    const GlSlabSource& source_;
    const SlicePlan& plan_;
    int height_;
    gl::Defines defines_;
    gl::Program program_;
    gl::Texture ranks_;  // of dithering
    GlMarch march_;
    GlPixels picture_;
    gl::WorkPace pace_;               // of rows
    gl::Fence drawn_;                 // behind the last band
    std::optional<GlCodeTree> tree_;  // if the plan has one
};

}  // namespace lamina
