// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
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

// Returns half-spaces whose intersection is kept: the planes', with normals scaled by powers of
// two, without rounding, then the box's six. Throws Error for zero normals, NaN and infinity.
std::vector<HalfSpace> half_spaces(const Clip& clip);

// Returns the part of a mesh (without cell scalars) in all half-spaces. A tet that a plane crosses
// becomes up to three of the same orientation. Conforming meshes stay conforming, and scalars are
// interpolated linearly. Corners within 1e-10 of the mesh's diagonal, or the rounding of large
// coordinates, count as on the plane. Unused points are dropped. `places`: TetMesh::places().
MeshData cut_mesh(MeshData mesh, std::span<const HalfSpace> clip,
                  std::span<const std::int32_t> places = {});

// Cuts a scene's mesh. Returns it unchanged if nothing is cut away, null if nothing is left. `lit`:
// keeps gradients of the uncut mesh, interpolated at new points (gradients_before_clip).
std::shared_ptr<const SceneMesh> clipped_mesh(const std::shared_ptr<const SceneMesh>& mesh,
                                              const Clip& clip, bool lit, const std::string& name);

}  // namespace lamina
