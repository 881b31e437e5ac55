// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "gl/texture.h"
#include "lamina/volume.h"
#include "plan/plan.h"

namespace lamina {

// The volume as 3D textures, one for each brick of the plan; for a lit plan also its gradients.
class VolumeTextures {
  public:
    // Samples that are not finite become NaN. Shows progress.
    VolumeTextures(const Volume& volume, const ValueRange& range, const SlicePlan& plan);

    // Tells whether it equals what the constructor would make.
    bool serves(const Volume& volume, const ValueRange& range, const SlicePlan& plan) const;

    const std::vector<gl::Texture>& bricks() const { return bricks_; }
    // as shaders/volume/gradient.glsl reads them; empty if the plan is not lit
    const std::vector<gl::Texture>& gradients() const { return gradients_; }

  private:
    Volume volume_;
    ValueRange range_;
    std::vector<TextureBrick> parts_;
    bool float_texture_, filtered_;
    std::vector<gl::Texture> bricks_, gradients_;
};

// Texels hold codes / largest. A scalar, with `range` as [0, 1], is (code - base) * scale. The
// codes of floats are scalars themselves.
struct SampleCodes {
    double largest = 1, base = 0, scale = 1;
};

SampleCodes sample_codes(const Volume& volume, const ValueRange& range, const SlicePlan& plan);

}  // namespace lamina
