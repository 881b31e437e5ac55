// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "facts/mesh_facts.h"

namespace lamina {

// Returns the tets, ascending, in which a surface may be at which what a ray shows jumps, apart
// from open faces: those that a jump of the transfer function passes through, and those that border
// on a tet without a value. Parallel. `facts`: of the data, but for these tets.
std::vector<std::int32_t> tets_with_surfaces(const Scene& scene, const SceneMesh& mesh,
                                             const MeshFacts& facts);

// Returns a bound on what roundings may change of the rays of the scene's pixels that run along a
// surface of the mesh at which what a ray shows jumps (docs/numerics.md, section 9.3, equation
// (9.8)); 0 if no ray does. The bound is for colours up to 1; full scale is 1. Such surfaces are
// the boundary of what the mesh shows, and the surfaces in tets at which the transfer function
// jumps or is very steep. A rounding, or the tie that renderers and tracer break (tie_pixels in
// scene/camera.h), decides for the whole ray on which side of the surface it runs. `facts`: of the
// data.
double surface_ray_error(const Scene& scene, const SceneMesh& mesh, const MeshFacts& facts);

}  // namespace lamina
