// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <filesystem>
#include <stop_token>
#include <string>
#include <vector>

#include "lamina/error.h"

namespace lamina {

class TransferFunction;
class Volume;

// Indices of the four corners (a, b, c, d) of a tet. A tet is positively oriented: det(b - a, c -
// a, d - a) > 0.
using Tet = std::array<std::int32_t, 4>;

// Face i of a tet lies opposite corner i. Its corners are counter-clockwise seen from outside the
// (positively oriented) tet.
inline constexpr std::array<std::array<std::size_t, 3>, 4> face_corners{
    {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

// One face of one tet.
struct TetFace {
    std::int32_t tet = 0;
    std::int32_t face = 0;
};

inline std::array<std::int32_t, 3> corners_of_face(const Tet& tet, std::size_t face) {
    const auto& corner = face_corners[face];
    return {tet[corner[0]], tet[corner[1]], tet[corner[2]]};
}

// A scalar of a mesh.
struct MeshScalar {
    std::string name;
    std::vector<double> values;  // one for each point, or one for each tet
};

// Counts the cells and points of a file that were changed or left out.
struct CellCounts {
    std::int64_t split = 0;            // cells other than tets that were cut into tets
    std::int64_t skipped = 0;          // vertices, lines, polygons: no volume
    std::int64_t straightened = 0;     // cells of higher order, cut into straight pieces
    std::int64_t turned_over = 0;      // tets that curved edges of these turn over
    std::int64_t not_star_shaped = 0;  // polyhedra not star-shaped from the mean of their points
    std::int64_t made_points = 0;      // points that cells needed and the file lacks
    std::int64_t ghosts = 0;           // cells that are marked as hidden or as another piece's
    std::int64_t merged_points = 0;    // points that another piece of the mesh also has; merged
};

// A tetrahedral mesh as a file or a generator gives it: nothing is checked or repaired. TetMesh
// (mesh/tet_mesh.h) is made from it, and mesh files are written from it.
struct MeshData {
    std::vector<glm::dvec3> points;  // world
    std::vector<Tet> tets;           // in the file's order and orientation
    std::vector<MeshScalar> point_scalars;
    std::vector<MeshScalar> cell_scalars;
    CellCounts cells;
    // The cell of the file from which each tet was cut, in rising order; empty: each tet is one.
    std::vector<std::int32_t> cell_of_tet;
};

// Settings for a mesh that is made from a volume (scene file: "mesh").
struct MeshSettings {
    double tolerance = 0.02;  // largest error, as a share of the volume's range of values; > 0
    std::int64_t max_tets = 5000000;
    // If true, every sample of the volume becomes a point, and every cell six tets (the Kuhn
    // split). Otherwise the mesh has as few tets as the tolerance allows.
    bool kuhn = false;

    friend bool operator==(const MeshSettings&, const MeshSettings&) = default;
};

// Describes the mesh that was made.
struct MeshReport {
    std::int64_t points = 0;
    std::int64_t tets = 0;
    std::int64_t kuhn_tets = 0;  // number of tets that the Kuhn split of the volume has
    int rounds = 0;              // rounds in which the adaptive mesh was refined
    double range = 0;            // largest minus least value of the volume
    // Largest difference between the mesh and the volume's trilinear field, anywhere, in the data's
    // units.
    double error = 0;
    bool within_tolerance = false;
    bool stopped_by_max_tets = false;

    double relative_error() const { return range > 0 ? error / range : 0; }
};

// A mesh that was made from a volume.
struct MadeMesh {
    MeshData mesh;  // with one scalar, "scalar", at its points
    MeshReport report;
};

// Makes tetrahedra that fill the volume's box (docs/meshes.md). The mesh may be coarse where
// `transfer_function` shows nothing (chosen_transfer_function() returns that of a scene); if it is
// null, the tolerance holds for all values. Throws Error for samples that are not finite, for a
// Kuhn split with more than settings.max_tets tets, and if lamina-tetrahedralize is neither beside
// the program or the library nor in PATH; Interrupted once a stop is requested.
LAMINA_API MadeMesh make_mesh(const Volume& volume, const MeshSettings& settings = {},
                              const TransferFunction* transfer_function = nullptr,
                              std::stop_token stop = {}, const ProgressCallback& progress = {});

// Reads a tetrahedral mesh with its scalars from a file of any kind that scenes may name
// (docs/scene.md, "What is drawn"). `only_below` means what it means for load_volume()
// (lamina/volume.h). Throws Error: one line that names the file, what was found and what was
// expected.
LAMINA_API MeshData load_mesh_data(const std::filesystem::path& file,
                                   const std::filesystem::path& only_below = {});

// Writes a mesh as .vtu in double precision. The file appears under its name when it is complete.
// Throws Error, also for other suffixes.
LAMINA_API void save_mesh(const MeshData& mesh, const std::filesystem::path& file);

}  // namespace lamina
