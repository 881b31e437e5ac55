// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <optional>
#include <vector>

#include "lamina/mesh_settings.h"
#include "lamina/scene.h"
#include "mesh/tet_mesh.h"

namespace lamina {

// Opens the volume that a scene names, as load_volume() loads it; it stays in its files if it does
// not fit the memory limit (volume_files/volume_opening.h). Throws Error.
Volume open_volume(const Scene& scene);

// The mesh that a scene draws, and the one scalar of it that is drawn.
struct SceneMesh {
    TetMesh mesh;
    MeshScalar scalar;      // one value a point
    bool averaged = false;  // the file has the scalar at cells; it was averaged to points
    std::optional<MeshReport> report;  // only for a mesh made from the scene's volume
    // Gradients, at the points, of the mesh before it was clipped, in scalar units per world unit;
    // empty unless it is lit and was clipped.
    std::vector<glm::dvec3> gradients_before_clip = {};
};

// Returns the gradients at the points by which the mesh is lit (docs/numerics.md, section 10).
std::vector<glm::dvec3> gradients_of(const SceneMesh& mesh);

// Returns how a mesh is made from the scene's volume: as the scene says, or by default.
MeshSettings mesh_settings(const Scene& scene);

// Returns the mesh's name for messages: its file, or the key of the scene that says how to make it.
std::string name_of_mesh(const Scene& scene);

// Reads the mesh that the scene names, or makes it from its volume. Throws Error, also if the file
// has no such scalar.
SceneMesh load_mesh(const Scene& scene);

// Make the scene's mesh from data in memory: a mesh, or a volume from which one is made.
SceneMesh scene_mesh(const Scene& scene, MeshData data);
SceneMesh scene_mesh(const Scene& scene, const Volume& volume);

}  // namespace lamina
