// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/enum_words.h"
#include "lamina/mesh.h"
#include "lamina/scene.h"
#include "lamina/settings.h"
#include "mesh/tet_mesh.h"

namespace lamina {

// Largest coordinate of lights, in world units: squares of distances far beyond it would overflow.
inline constexpr double largest_scene_coordinate = 1e100;

// A mistake in a lighting, because of which it cannot be drawn.
struct LightingMistake {
    std::string key;      // "power", "lights.2.direction"
    std::string message;  // "found 0, expected ..."
};
std::optional<LightingMistake> mistake_in(const Lighting& lighting);

// Throws Error if the scene has a lighting that cannot be drawn.
void check_lighting(const Scene& scene);

// Tells whether a colouring averages colours of a tet's corners or a segment's ends, even those of
// extinction 0. It then needs triangles that fan out from a vertex (ProjectGeometry::triangles),
// because only their vertices carry interpolated values.
inline bool mixes_colors(Coloring coloring) {
    switch (coloring) {
        case Coloring::preintegrated:
        case Coloring::analytic:
            return false;
        case Coloring::attenuation:
        case Coloring::vertex:
            return true;
    }
    unreachable_enum();
}

// Loads as load_volume() does, but leaves volumes beyond the memory limit in files. Throws Error.
Volume open_volume(const Scene& scene);

// The mesh that a scene draws, and the one scalar of it that is drawn.
struct SceneMesh {
    TetMesh mesh;
    MeshScalar scalar;      // one value for each point
    bool averaged = false;  // the file has the scalar at cells; it was averaged to points
    std::optional<MeshReport> report;  // only for a mesh made from the scene's volume
    // Gradients at the points, per world unit, before the clip; empty unless a lit mesh was cut.
    std::vector<glm::dvec3> gradients_before_clip = {};
    Quantity quantity = {};        // that the scalar measures
    std::string length_unit = {};  // of the world; empty if it is unknown
};

// Returns the gradients at the points by which the mesh is lit (docs/numerics.md, section 10).
std::vector<glm::dvec3> gradients_of(const SceneMesh& mesh);

// Returns how a mesh is made from the scene's volume: as the scene says, or by default.
MeshSettings mesh_settings(const Scene& scene);

// Returns the mesh's name for messages: its file or, if made from the volume, scene file and key.
std::string name_of_mesh(const Scene& scene);

// Reads or makes the scene's mesh. Throws Error, also if the mesh lacks the scalar.
SceneMesh load_mesh(const Scene& scene);

// Make the scene's mesh from data in memory: a mesh, or a volume from which one is made.
SceneMesh scene_mesh(const Scene& scene, MeshData data);
SceneMesh scene_mesh(const Scene& scene, const Volume& volume);

}  // namespace lamina
