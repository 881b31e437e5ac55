// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lamina/scene.h"
#include "lamina/volume.h"
#include "mesh/tet_mesh.h"
#include "scene/scene.h"

namespace lamina::fuzz {

// Measures and plans for the cpu engine and for what OpenGL typically can do, with omissions and
// without; throws Error where nothing can be planned, and Violation where a number of facts or plan
// is none or beyond its limits.
void check_slice_plans(const Scene& scene, const Volume& volume);
void check_project_plans(const Scene& scene, const SceneMesh& mesh);

// A scene without a choice of its own around data that come from a file: drawn with `method`, the
// eye before the box, extinction where the scalars are.
struct Box {
    glm::dvec3 min{0}, max{0};
};
Scene scene_around(const Box& box, double lowest, double highest, Method method);

}  // namespace lamina::fuzz
