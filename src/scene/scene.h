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

// A part of a lighting that cannot be drawn.
struct LightingMistake {
    std::string key;      // "power", "lights.2.direction"
    std::string message;  // "found 0, expected ..."
};
std::optional<LightingMistake> mistake_in(const Lighting& lighting);

// Throws Error for the scene's lighting, if it has any that cannot be drawn.
void check_lighting(const Scene& scene);

// Tells whether colours are means, of points of a tet or of the ends of a segment. Means mix
// colours whatever their extinction, and only the vertices of a fan carry interpolated values.
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

// Opens the volume that a scene names, as load_volume() loads it; it stays in its files if it does
// not fit the memory limit (volume_files/volume_opening.h). Throws Error.
Volume open_volume(const Scene& scene);

// The mesh that a scene draws, and the one scalar of it that is drawn.
struct SceneMesh {
    TetMesh mesh;
    MeshScalar scalar;      // one value a point
    bool averaged = false;  // the file has the scalar at cells; it was averaged to points
    std::optional<MeshReport> report;  // only for a mesh made from the scene's volume
    // Gradients at the points before the mesh was clipped, per world unit; only of a lit mesh.
    std::vector<glm::dvec3> gradients_before_clip = {};
};

// Returns the gradients at the points by which the mesh is lit (docs/numerics.md, section 10).
std::vector<glm::dvec3> gradients_of(const SceneMesh& mesh);

// Returns how a mesh is made from the scene's volume: as the scene says, or by default.
MeshSettings mesh_settings(const Scene& scene);

// Returns the mesh's name for messages: its file, or the key of the scene that says how to make it.
std::string name_of_mesh(const Scene& scene);

// Reads the scene's mesh or makes it from its volume. Throws Error, also for want of the scalar.
SceneMesh load_mesh(const Scene& scene);

// Make the scene's mesh from data in memory: a mesh, or a volume from which one is made.
SceneMesh scene_mesh(const Scene& scene, MeshData data);
SceneMesh scene_mesh(const Scene& scene, const Volume& volume);

}  // namespace lamina
