// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "lamina/mesh_data.h"
#include "lamina/tet.h"

namespace lamina {

// What was found, and partly repaired, while a mesh was assembled.
struct MeshFindings {
    std::int64_t tets_read = 0;
    // Tets of exactly zero volume. Those with a repeated corner are dropped. The others are kept,
    // because they connect their neighbours.
    std::int64_t degenerate = 0;
    // Number of degenerate tets with a repeated corner, which are dropped.
    std::int64_t repeated_corners = 0;
    std::int64_t inverted = 0;    // tets of negative orientation, whose corners are reordered
    std::int64_t duplicates = 0;  // tets with the same corners as an earlier tet, which are dropped
    std::int64_t boundary_faces = 0;     // faces of one tet
    std::int64_t nonmanifold_faces = 0;  // faces of three or more tets
    std::int64_t folded_faces = 0;       // faces of two tets that lie on the same side of it
    std::int64_t unused_points = 0;
    CellCounts cells;  // cells of the file

    // Every interior face is shared by exactly two tets.
    bool conforming() const { return nonmanifold_faces == 0; }
};

// Tetrahedra with positive orientation and their neighbours. Immutable.
class TetMesh {
  public:
    static constexpr std::int32_t no_neighbor = -1;

    // `name`: name of the file, for messages. Throws Error for a mesh without tets, for corner
    // indices out of range, and for points of tets that are not finite or beyond 1e100. Runs on all
    // cores and takes some 130 bytes a tet beside the mesh itself.
    TetMesh(MeshData data, const std::string& name);

    std::span<const glm::dvec3> points() const { return points_; }
    std::span<const Tet> tets() const { return tets_; }
    // The tet across face i (opposite corner i), or no_neighbor. Boundary faces have none, and
    // neither have folded and nonmanifold faces, because a ray cannot cross these from one tet into
    // exactly one other.
    std::span<const std::array<std::int32_t, 4>> neighbors() const { return neighbors_; }
    // All faces without a neighbour.
    std::span<const TetFace> open_faces() const { return open_faces_; }
    // The corners of a face, counter-clockwise as seen from outside its tet.
    std::array<glm::dvec3, 3> corners(const TetFace& face) const;

    // The tets of exactly zero volume. They have faces and neighbours but show nothing.
    std::span<const std::int32_t> flat_tets() const { return flat_; }

    const MeshFindings& findings() const { return findings_; }
    std::span<const MeshScalar> point_scalars() const { return point_scalars_; }
    std::span<const MeshScalar> cell_scalars() const { return cell_scalars_; }

    struct Bounds {
        glm::dvec3 min{0}, max{0};
    };
    const Bounds& bounds() const { return bounds_; }  // bounds of the points that tets use

  private:
    void check_corners(const std::string& name) const;
    void check_points(const std::string& name);
    void drop(const std::vector<char>& dropped);  // drops marked tets, with their cell scalars
    void drop_repeated_corners();
    void orient();
    void orient_flat();
    void cut_folded_faces();
    void list_open_faces();

    std::vector<glm::dvec3> points_;
    std::vector<Tet> tets_;
    std::vector<std::array<std::int32_t, 4>> neighbors_;
    std::vector<TetFace> open_faces_;
    std::vector<std::int32_t> flat_;
    std::vector<MeshScalar> point_scalars_, cell_scalars_;
    MeshFindings findings_;
    Bounds bounds_;
};

}  // namespace lamina
