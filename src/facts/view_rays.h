// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "facts/mesh_facts.h"

namespace lamina {

// Returns rays of the scene's view, all over the picture, as segments in tets, nearest first. Rays
// that meet no tet are left out, and so are tets with values that are not finite.
std::vector<std::vector<MeshFacts::Run>> find_view_rays(const Scene& scene, const SceneMesh& mesh);

}  // namespace lamina
