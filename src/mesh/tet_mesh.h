// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <limits>

#include "lamina/mesh.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// The numbers of the corners at the ends of a tet's six edges.
inline constexpr std::array<std::array<std::size_t, 2>, 6> tet_edges{
    {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

// Faults that were found, and partly repaired, while a mesh was assembled.
struct MeshFindings {
    std::int64_t tets_read = 0;
    // Tets of exactly zero volume: flat_tets(), which TetMesh keeps, and repeated_corners.
    std::int64_t degenerate = 0;
    std::int64_t repeated_corners = 0;  // tets with a corner (or a copy) twice, which are dropped
    std::int64_t inverted = 0;          // tets of negative orientation, whose corners are reordered
    std::int64_t duplicates = 0;  // tets with the same corners as an earlier tet, which are dropped
    std::int64_t boundary_faces = 0;     // faces of one tet
    std::int64_t nonmanifold_faces = 0;  // faces of three or more tets
    std::int64_t folded_faces = 0;       // faces of two tets that lie on the same side of it
    std::int64_t unused_points = 0;
    std::int64_t copies = 0;  // points at the place of an earlier one (TetMesh::places())
    CellCounts cells;         // the file's cells and points that were changed or left out

    bool conforming() const { return nonmanifold_faces == 0; }
};

// A tetrahedral mesh: tets of positive orientation, with their neighbours. Immutable.
// Adjacency is by place, values are by corner: points at exactly equal places (copies) are one for
// all that compares tets by their corners, and each has its own value.
class TetMesh {
  public:
    static constexpr std::int32_t no_neighbor = -1;

    // `name`: the file's, for messages. Throws Error if the mesh has no tets, corners out of range,
    // or points that are not finite or beyond 1e100. Takes some 130 bytes a tet.
    TetMesh(MeshData data, const std::string& name);

    std::span<const glm::dvec3> points() const { return points_; }
    std::span<const Tet> tets() const { return tets_; }
    // Returns the tets across each tet's faces; no_neighbor: it is boundary, folded or nonmanifold.
    std::span<const std::array<std::int32_t, 4>> neighbors() const { return neighbors_; }
    std::span<const TetFace> open_faces() const { return open_faces_; }

    bool has_copies() const { return !places_.empty(); }
    // Returns for each point the first one at its place; empty if the mesh has no copies. A copy
    // whose faces all have their two tets by index joins nothing, and may not be found.
    std::span<const std::int32_t> places() const { return places_; }
    std::int32_t place(std::int32_t point) const {
        return places_.empty() ? point : places_[static_cast<std::size_t>(point)];
    }
    // Returns a tet's corners as places, which are the same in all tets that share them.
    Tet place(const Tet& tet) const {
        return {place(tet[0]), place(tet[1]), place(tet[2]), place(tet[3])};
    }
    // Returns the corner of a tet at the place of `point`, which must be one of its corners'.
    std::int32_t corner_at(std::int32_t tet, std::int32_t point) const;
    // Returns the corners of a face, counter-clockwise as seen from outside of its tet.
    std::array<glm::dvec3, 3> corners(const TetFace& face) const;
    std::array<glm::dvec3, 4> corners(std::int32_t tet) const {
        const auto& [a, b, c, d] = tets_[static_cast<std::size_t>(tet)];
        const auto point = [&](std::int32_t corner) {
            return points_[static_cast<std::size_t>(corner)];
        };
        return {point(a), point(b), point(c), point(d)};
    }

    // Returns the tets of exactly zero volume, which show nothing.
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
    void drop_repeated_corners(const std::string& name);
    void find_neighbors();
    bool find_copies();
    void orient();
    void orient_flat();
    void cut_folded_faces();
    void list_open_faces();

    std::vector<glm::dvec3> points_;
    std::vector<std::int32_t> places_;
    std::vector<Tet> tets_;
    std::vector<std::array<std::int32_t, 4>> neighbors_;
    std::vector<TetFace> open_faces_;
    std::vector<std::int32_t> flat_;
    std::vector<MeshScalar> point_scalars_, cell_scalars_;
    MeshFindings findings_;
    Bounds bounds_;
};

// Converts cell data to point data: the plain mean over the tets around a point, as in VTK's
// vtkCellDataToPointData. The mean by volume would be off by slope * (H - h) / 2 in a linear field
// between cells of lengths h < H, the plain mean by half of that. A NaN reaches all points of its
// tet. Points without tets get the first finite value of all. `cell_of_tet`: as in MeshData; the
// mean is then over the file's cells.
MeshScalar average_to_points(std::size_t point_count, std::span<const Tet> tets,
                             const MeshScalar& scalar,
                             std::span<const std::int32_t> cell_of_tet = {});

// Returns the only array of cell data, which is drawn if there are no scalars at points and a scene
// names none, or null. A vector's length stands for the vector.
const MeshScalar* only_array(const std::vector<MeshScalar>& cell_scalars);

// Returns the gradient at the points, in scalar units per world unit (docs/numerics.md, section
// 10): the mean over the tets around a point, weighted by volume. Copies with equal values count as
// one point. Tets without volume, or with a value that is not finite, do not count; the gradient is
// 0 if no other tet is around the point.
std::vector<glm::dvec3> point_gradients(const TetMesh& mesh, std::span<const double> scalar);

// Returns for each point one at its place with its value; empty if there are no copies. Values that
// differ by up to 1e-6 of themselves are one: programs that write copies round each one for itself.
std::vector<std::int32_t> equal_points(const TetMesh& mesh, std::span<const double> scalar);

// Counts the faces of two tets that have different values at a corner.
std::int64_t count_jumps(const TetMesh& mesh, std::span<const double> scalar);

struct ScalarRange {
    ValueRange range;             // range of the finite values
    std::int64_t non_finite = 0;  // number of NaN or infinite values
};

// Returns the range of the values at a tet's corners; empty if one of them is not finite.
inline ValueRange range_in(std::span<const double> values, const Tet& tet) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    ValueRange range{infinity, -infinity};
    for (const std::int32_t corner : tet) {
        const double value = values[corner];
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
