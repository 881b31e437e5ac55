// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "lamina/mesh.h"
#include "lamina/settings.h"
#include "scene/scene.h"

namespace lamina {

// The points p of the world with dot(normal, p - point) >= 0. The normal's largest component lies
// between 1 and 2, so that its products do not overflow in any scene.
struct HalfSpace {
    glm::dvec3 point, normal;
};

// Returns the half-spaces whose common part a clip keeps: of the planes, then six of the box.
// Normals are scaled by powers of two, exactly. Throws Error if one is zero or a number is none.
std::vector<HalfSpace> half_spaces(const Clip& clip);

// Returns the part of a mesh without cell scalars that lies in all half-spaces. A tet that a plane
// crosses becomes up to three of its orientation, so that a conforming mesh stays one; scalars are
// interpolated linearly. Corners nearer to a plane than 1e-10 of the mesh's diagonal, or roundings
// of large coordinates, lie on it. Points that no tet uses are dropped.
MeshData cut_mesh(MeshData mesh, std::span<const HalfSpace> clip);

// Cuts a scene's mesh: returns the mesh itself if nothing is cut away, null if nothing is left.
// `lit`: the gradients before the cut are kept, interpolated linearly as in the tets.
std::shared_ptr<const SceneMesh> clipped_mesh(const std::shared_ptr<const SceneMesh>& mesh,
                                              const Clip& clip, bool lit, const std::string& name);

}  // namespace lamina
