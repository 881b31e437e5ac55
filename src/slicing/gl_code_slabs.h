// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/client.h"
#include "executors/gl_pixels.h"
#include "gl/texture.h"
#include "plan/capabilities.h"
#include "slicing/gl_march.h"

namespace lamina {

// Returns the ranks of dithering as shaders/slicing/dither_ranks.glsl reads them.
gl::Texture upload_ranks(const Dither& dither);
inline constexpr int ranks_unit = GlSlabSource::first_free_unit;

// Draws slabs for Target::emulated: a compute shader composites each ray's slabs on codes, in
// registers. The picture is made in bands of rows.
class GlCodeSlabs : public GlMarchedPicture {
  public:
    // `source` and `plan` must outlive the object.
    GlCodeSlabs(const GlSlabSource& source, const SlicePlan& plan, const Capabilities& capabilities,
                int width, int height);

    int step_count() const override { return height_; }  // rows
    void take_plan() override;
    void set_view(const View& view, const Slabs& slabs) override;
    void clear() override { picture_.clear(); }
    void draw(Progress* progress) override;
    void read(Image& image) const override;

  private:
    gl::Defines wanted_defines() const;

    const GlSlabSource& source_;
    const SlicePlan& plan_;
    int height_;
    gl::Defines defines_;
    gl::Program program_;
    gl::Texture ranks_;  // of dithering
    GlMarch march_;
    GlPixels picture_;
    RowPace pace_;
};

}  // namespace lamina
