// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "scene/scene_mesh.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// What a mesh really contains: measured, not declared.
struct MeshFacts {
    std::int64_t points = 0;
    std::int64_t tets = 0;
    std::string scalar;  // its name
    ValueRange range;    // of the finite values
    std::int64_t non_finite = 0;
    MeshFindings findings;
};

// Throws Error when the scalar has values that are no finite numbers and the scene does not say
// what to do with them, or has none but such.
MeshFacts measure(const Scene& scene, const SceneMesh& mesh);

}  // namespace lamina
