// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "gl/api.h"
#include "gl/texture.h"
#include "lamina/volume.h"
#include "plan/plan.h"

namespace lamina {

// The volume in OpenGL's memory, in the bricks of the plan: as 3D textures, or as words of storage
// buffers (SlicedPicture::words). For a lit plan also its gradients, as textures.
class GlVolume {
  public:
    // Uploads the volume and shows progress. Samples that are not finite become NaN.
    GlVolume(const Volume& volume, const ValueRange& range, const SlicePlan& plan);

    // Tells whether this object can be used in place of a new one made from these arguments.
    bool can_replace(const Volume& volume, const ValueRange& range, const SlicePlan& plan) const;

    // Binds a brick's samples to a texture unit, or to the storage block of shaders/slicing.
    void bind(std::size_t brick, unsigned unit) const;
    // Returns the gradients that shaders/volume/gradient.glsl reads; empty if the plan is not lit.
    const std::vector<gl::Texture>& gradients() const { return gradients_; }

  private:
    Volume volume_;
    ValueRange range_;
    std::vector<TextureBrick> parts_;
    bool float_samples_, filtered_;
    std::vector<gl::Texture> textures_, gradients_;
    std::vector<gl::Buffer> words_;
};

}  // namespace lamina
