// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "facts/facts.h"
#include "lamina/volume.h"
#include "plan/capabilities.h"
#include "plan/sample_trials.h"

namespace lamina {

// Where the scene is sliced into an automatic number of slabs: what numbers of slabs cost in
// accuracy. Pictures of them are drawn with the native engine, in float32, and held against the
// reference tracer until the fewest that keep slab_error_goal() are known to some 10 %, or more of
// them do not help, or 16 a voxel do not keep it; then two a voxel are tried, too. Where errors are
// not of second order, some fewer slabs are tried after that.
//
// Pictures of at most 81,920 pixels are traced on each of them. Larger ones are searched in 2^13
// pixels first, and from what was found on in a picture of at most 2^20: there trials are compared
// with pictures of more slabs, and with the tracer on 12288 pixels.
//
// For "filter": "auto" in a context whose texture units' weights are worth it, the same with such
// weights, from the slabs on that exact scalars need; or with as many slabs as the scene asks for.
SampleTrials try_samples(const Scene& scene, const Volume& volume, const MinMaxBricks& bricks,
                         const Facts& facts, const Capabilities& capabilities);

}  // namespace lamina
