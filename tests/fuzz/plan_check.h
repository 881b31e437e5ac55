// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lamina/scene.h"
#include "lamina/volume.h"
#include "mesh/tet_mesh.h"
#include "scene/scene.h"

namespace lamina::fuzz {

// Measure the data and plan for the cpu engine and for typical OpenGL contexts, with omissions and
// without. Throw Error if the data cannot be measured, and Violation if a number of the facts or of
// a plan is not finite or beyond its limits.
void check_slice_plans(const Scene& scene, const Volume& volume);
void check_project_plans(const Scene& scene, const SceneMesh& mesh);

// The box of data; scene_around() returns a simple scene of data in this box: drawn with `method`,
// the eye in front of the box, and extinction over the range lowest .. highest of the scalars.
struct Box {
    glm::dvec3 min{0}, max{0};
};
Scene scene_around(const Box& box, double lowest, double highest, Method method);

}  // namespace lamina::fuzz
