// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/facts.h"
#include "volume/volume.h"

namespace lamina {

// measure(), and, where the scene is sliced into an automatic number of slabs, what numbers of
// slabs cost in accuracy: pictures of N and of more slabs are drawn with the native engine, in
// float32, until the fewest that keep slab_error_goal() are known to some 10 %, or more of
// them do not help, or 16 a voxel do not keep it; then two a voxel are tried, too. Pictures are
// smaller than the scene's where that has more than 2^17 pixels. Where the filter is automatic,
// the weights of texture units are tried in the same way, or with the number of slabs that is
// given.
Facts measure_slicing(const Scene& scene, const Volume& volume, const MinMaxBricks& bricks);

}  // namespace lamina
