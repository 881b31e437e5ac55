// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "facts/volume_facts.h"
#include "lamina/scene.h"

namespace lamina {

// Bounds on what roundings may change of the scene's rays that run along a surface of a volume at
// which what a ray shows jumps (docs/numerics.md, section 9.3), as shares of full scale for colours
// up to 1. Meshes have surface_ray_error() (facts/surface_rays.h).
struct SurfaceError {
    double steps = 0;  // at jumps of the transfer function, and in faces between voxels
    double all = 0;    // in its ramps, too
};

SurfaceError surface_error(const Scene& scene, const Facts& facts);

}  // namespace lamina
