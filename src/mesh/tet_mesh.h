// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <glm/vec3.hpp>
#include "lamina/mesh_data.h"
#include "lamina/tet.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// The tet across each face, found by corner indices alone. Faces of three or more tets have none.
struct FaceMatching {
    // Tet across face i; -1 if there is none.
    std::vector<std::array<std::int32_t, 4>> neighbors;
    // Tets with the same corners as an earlier tet, ascending.
    std::vector<std::int32_t> duplicates;
    std::int64_t boundary_faces = 0;     // number of faces of one tet
    std::int64_t nonmanifold_faces = 0;  // number of faces of three or more tets
};

// Matches faces by sorting, on all cores, with 48 bytes a tet of working memory. `tets`: four
// different corners each, all in [0, point_count); fewer than 2^29 tets.
FaceMatching match_faces(std::span<const Tet> tets, std::size_t point_count);

// Faults that were found, and partly repaired, while a mesh was assembled.
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

    // Tells whether every interior face is shared by exactly two tets.
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
    // Returns the tet across face i (opposite corner i), or no_neighbor. Boundary faces have none,
    // and neither have folded and nonmanifold faces, because a ray cannot cross these from one tet
    // into exactly one other.
    std::span<const std::array<std::int32_t, 4>> neighbors() const { return neighbors_; }
    // Returns all faces without a neighbour.
    std::span<const TetFace> open_faces() const { return open_faces_; }
    // Returns the corners of a face, counter-clockwise as seen from outside its tet.
    std::array<glm::dvec3, 3> corners(const TetFace& face) const;

    // Returns the tets of exactly zero volume. They have faces and neighbours but show nothing.
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

// Converts cell data to point data: each point gets the mean over the tets around it, all with the
// same weight, as from vtkCellDataToPointData (a hexahedron that was cut counts once for each tet).
// Weights by volume would keep the field's integral but favour the larger side: between cells of
// lengths h < H with the centre values of a linear field they miss the value in the middle by slope
// * (H - h) / 2, the plain mean by half of that. A NaN reaches all points of its tet. Points
// without tets are never drawn and get the first finite value of all tets, so that ranges and
// counts do not change. `tets` must have indices < point_count, and `scalar` one value a tet.
MeshScalar average_to_points(std::size_t point_count, std::span<const Tet> tets,
                             const MeshScalar& scalar);

// Returns the gradient of a scalar at the points of a mesh, in scalar units per world unit
// (docs/numerics.md, section 10): the mean of the constant gradients of the tets around a point,
// weighted by their volumes. `scalar`: one value a point. Tets of no volume, and those with a value
// that is not finite, do not count; if none is left the gradient is 0.
std::vector<glm::dvec3> point_gradients(const TetMesh& mesh, std::span<const double> scalar);

// The values of a scalar of a mesh.
struct ScalarRange {
    ValueRange range;             // range of the finite values
    std::int64_t non_finite = 0;  // number of NaN or infinite values
};

// Returns the range of the values at a tet's corners; empty if one of them is not finite.
inline ValueRange range_in(std::span<const double> values, const Tet& tet) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    ValueRange range{infinity, -infinity};
    for (const std::int32_t corner : tet) {
        const double value = values[static_cast<std::size_t>(corner)];
        if (!std::isfinite(value)) return {infinity, -infinity};
        range.lo = std::min(range.lo, value);
        range.hi = std::max(range.hi, value);
    }
    return range;
}

inline ScalarRange measure_range(std::span<const double> values) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    ScalarRange found{{infinity, -infinity}, 0};
    for (const double value : values) {
        if (!std::isfinite(value)) {
            ++found.non_finite;
            continue;
        }
        found.range.lo = std::min(found.range.lo, value);
        found.range.hi = std::max(found.range.hi, value);
    }
    return found;
}

}  // namespace lamina
