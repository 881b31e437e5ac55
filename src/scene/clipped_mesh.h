// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>

#include "lamina/mesh_data.h"
#include "scene/half_space.h"
#include "scene/scene_mesh.h"

namespace lamina {

// Returns the part of a mesh that lies in all half-spaces. Tets that a plane crosses are replaced
// by up to three, so that a conforming mesh stays one; their scalars are interpolated linearly.
// Corners nearer to a plane than 1e-10 of the mesh's diagonal (or than roundings of large
// coordinates) lie on it, because thinner tets would consist of roundings. Orientations stay.
// Points that no tet uses are dropped. Meshes with cell scalars cannot be cut.
MeshData cut_mesh(MeshData mesh, std::span<const HalfSpace> clip);

// Cuts a scene's mesh: returns the mesh itself if nothing is cut away, null if nothing is left.
// `lit`: the gradients of the mesh before it was clipped are kept, interpolated linearly, as they
// are in its tets.
std::shared_ptr<const SceneMesh> clipped_mesh(const std::shared_ptr<const SceneMesh>& mesh,
                                              const Clip& clip, bool lit, const std::string& name);

}  // namespace lamina
