// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "lamina/image.h"
#include "lamina/scene.h"
#include "reference/tiles.h"
#include "render/scene_data.h"

namespace lamina {

// A picture of the reference tracer, or of its plain twin.
struct TracedPicture {
    PreciseImage image;  // associated RGBA, before any background
    // The largest error over all pixels and channels, as a share of full scale, as the tracer
    // estimates it.
    double error_estimate = 0;
    std::int64_t segments = 0;          // of rays, with extinction
    std::int64_t overlapping_rays = 0;  // that meet tets of a mesh that overlap
};

// Returns the scene as one to be traced: its volume or its mesh.
Scene as_trace(Scene scene, TraceOf of);

// Traces the data that the scene draws, whatever its method, to its trace_tolerance. Nothing in the
// scene's transfer function and camera may be automatic.
TracedPicture trace_picture(const Scene& scene, SceneData& data, const TileDone& tile_done = {});

// Traces with the plain twin of the tracer (plain/plain_tracer.h), which counts no overlapping rays
// and takes no tolerance.
TracedPicture plainly_traced_picture(const Scene& scene, SceneData& data);

}  // namespace lamina
