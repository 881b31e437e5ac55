// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "plan/plan.h"

namespace lamina {

// Cuts the volume into the fewest bricks that respect the context's limits: the longest edge is cut
// once more until all fit. `bordered`: bricks get one more sample at both ends of each `cell` axis,
// which repeats the border. The half voxels there then lie between samples of the brick, and no
// other sample, which may be NaN, is read with a weight of 0. Throws Error where even two samples
// along an axis are too many.
std::vector<TextureBrick> cut_into_bricks(const Grid& grid, bool bordered,
                                          std::uint64_t texel_bytes,
                                          const Capabilities& capabilities);

// The bytes of the largest texel that a sample takes: OpenGL has lit volumes' gradients in
// textures, too (slicing/gradient_map.h).
std::uint64_t texel_bytes(const SlicePlan& plan, SampleType type, const Capabilities& capabilities);

}  // namespace lamina
