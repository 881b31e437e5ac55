// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "gl/texture.h"
#include "lamina/volume.h"
#include "plan/plan.h"

namespace lamina {

// The volume as 3D textures, one a brick of the plan; of a lit plan, those of its gradients, too.
class VolumeTextures {
  public:
    // Samples that are no finite numbers become NaN. Shows progress.
    VolumeTextures(const Volume& volume, const ValueRange& range, const SlicePlan& plan);

    // Whether it is what the constructor would make.
    bool serves(const Volume& volume, const ValueRange& range, const SlicePlan& plan) const;

    const std::vector<gl::Texture>& bricks() const { return bricks_; }
    // shaders/volume/gradient.glsl; empty where the plan is not lit.
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
