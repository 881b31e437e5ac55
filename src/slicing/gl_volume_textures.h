// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>

#include <vector>

#include "gl/texture.h"
#include "lamina/volume.h"
#include "plan/plan.h"

namespace lamina {

// The volume as 3D textures, one for each brick of the plan.
struct VolumeTextures {
    std::vector<gl::Texture> bricks;
    // Scale and offset that turn what a shader reads into scalars with `range` as [0, 1].
    glm::vec2 normalisation{1, 0};
};

// Uploads the volume, with progress. Samples that are not finite become NaN.
VolumeTextures upload_volume(const Volume& volume, const ValueRange& range, const SlicePlan& plan);

}  // namespace lamina
