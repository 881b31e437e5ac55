// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "facts/volume_facts.h"
#include "scene/scene.h"

namespace lamina {

// Tells whether a pixel's ray runs in a face between two voxels. If each voxel has one value, a
// rounding decides which of the two such a ray sees, for its whole length.
bool rays_run_in_voxel_faces(const Scene& scene, const Facts& facts);

}  // namespace lamina
