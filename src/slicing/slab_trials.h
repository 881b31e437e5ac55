// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "facts/volume_facts.h"
#include "lamina/volume.h"
#include "plan/capabilities.h"
#include "plan/choices.h"
#include "preintegration/preintegration_table.h"

namespace lamina {

// Measures the error of different numbers of slabs if the scene has an automatic number of slabs.
// Trial pictures are drawn by the engine `cpu`, in float32, and compared with the reference tracer.
// The search ends when the fewest slabs that keep slab_error_goal() are known to some 10 %, when
// more slabs do not help, or when 16 slabs a voxel do not keep the goal. In the last two cases two
// slabs a voxel are tried, too. If errors are not of second order, some smaller numbers are tried
// after that.
//
// Pictures of at most 81,920 pixels are traced in every pixel. Larger pictures are first searched
// with 2^13 pixels. From the number of slabs found there the search goes on with a picture of at
// most 2^20 pixels, in which trials are compared with pictures of more slabs, and with the tracer
// on 12288 pixels.
//
// For "filter": "auto", in a context whose texture units have weights worth using, the search is
// repeated with such weights. It then starts from the number of slabs that exact scalars need. If
// the scene gives the number of slabs, only that number is tried.
//
// If "classification": "auto" has exact segments, no number is tried for one picture: the search
// would take longer than it saves. For `many_frames` post-classified slabs are tried, as long as
// they are few enough to be quicker (quicker_slabs_per_voxel); if they do not keep the goal the
// result is empty.
SampleTrials try_samples(const Scene& scene, const Volume& volume, const MinMaxBricks& bricks,
                         const Facts& facts, const Capabilities& capabilities, bool many_frames,
                         TableCache& tables);

}  // namespace lamina
