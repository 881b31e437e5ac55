// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace lamina {

// Squares of distances far beyond this, in world units, would overflow.
inline constexpr double largest_scene_coordinate = 1e100;

}  // namespace lamina
