// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "facts/volume_facts.h"
#include "lamina/volume.h"
#include "plan/capabilities.h"
#include "plan/choices.h"
#include "preintegration/preintegration_table.h"

namespace lamina {

// Measures the error of different numbers of slabs, if the scene's number is automatic. Trial
// pictures, drawn by the engine `cpu` in float32, are compared with the reference tracer. The
// search ends when the smallest number that keeps slab_error_goal() is known to some 10 %. It also
// ends if more slabs do not help, or if 16 a voxel do not keep the goal; then two a voxel are
// tried. If errors are not of second order, some smaller numbers follow.
//
// Pictures of at most 81,920 pixels are traced in every pixel. A larger picture is searched at 2^13
// pixels first, and then, from the number found there, at up to 2^20 pixels. Those trials are
// compared with pictures of more slabs, and with the tracer on 12,288 pixels.
//
// If "filter" is "auto" and texture units have 8-bit weights, the search is repeated with these,
// from the number that exact weights need. If the scene gives the number, only that is tried.
//
// If "classification": "auto" chooses exact segments, nothing is tried for a single picture: the
// search would cost more than it saves. For `many_frames`, post-classified slabs are tried, few
// enough to be quicker (quicker_slabs_per_voxel); if none keeps the goal, the result is empty.
SampleTrials try_samples(const Scene& scene, const Volume& volume, const MinMaxBricks& bricks,
                         const Facts& facts, const Capabilities& capabilities, bool many_frames,
                         TableCache& tables);

}  // namespace lamina
