// SPDX-License-Identifier: Apache-2.0
// The plain twin of the reference tracer, to judge the judge. It shares no code with the tracer and
// is as short as it can be; it holds each ray against all planes of the grid, or all tets, and
// integrates by plain quadrature, so it is slow.
#pragma once

#include <cstdint>

#include "lamina/image.h"
#include "lamina/scene.h"
#include "scene/scene_mesh.h"

namespace lamina {

struct PlainPicture {
    PreciseImage image;  // associated RGBA, before any background
    // The largest error of a pixel, as a share of full scale, as estimated: rounding is not in it.
    double error_estimate = 0;
    std::int64_t segments = 0;  // parts of rays with extinction, each in one cell or tet
};

// Traces what the scene shows of its data, whatever its method and trace_tolerance. Cells and tets
// with a corner that is NaN or infinite are transparent. Tets that overlap are composited one after
// the other, in the order in which the ray enters them. Nothing in the scene is automatic.
PlainPicture trace_plainly(const Scene& scene, const Volume& volume);
PlainPicture trace_plainly(const Scene& scene, const SceneMesh& mesh);

}  // namespace lamina
