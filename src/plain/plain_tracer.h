// SPDX-License-Identifier: Apache-2.0
// A plain second reference tracer, with which the first is checked. It shares no code with that,
// intersects each ray with all planes of a grid or all tets, and is slow.
#pragma once

#include <cstdint>

#include "lamina/image.h"
#include "lamina/scene.h"
#include "scene/scene.h"

namespace lamina {

struct PlainPicture {
    PreciseImage image;         // associated RGBA, before any background
    double error_estimate = 0;  // worst pixel's, as a share of full scale, without rounding
    std::int64_t segments = 0;  // parts of rays, each in one cell or tet
};

// Traces a scene, whatever its method and trace_tolerance; nothing in it is automatic. Cells and
// tets with a NaN or infinite corner are transparent. Tets that overlap are composited one after
// the other, in the order in which the ray enters them.
PlainPicture trace_plainly(const Scene& scene, const Volume& volume);
PlainPicture trace_plainly(const Scene& scene, const SceneMesh& mesh);

}  // namespace lamina
