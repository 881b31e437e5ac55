// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "lamina/mesh.h"
#include "mesh/point_table.h"
#include "mesh_files/cell_lattice.h"

namespace lamina {

// Adds points that cells need and files lack. Each is a weighted sum of a mesh's points, and so are
// its values.
class MadePoints {
  public:
    MadePoints(MeshData& mesh, PointPlaces& places) : mesh_(mesh), places_(places) {}

    // Adds a point and returns its index. Throws Error beyond 2^31 - 1 points. `sources`: points of
    // the mesh that are not made.
    std::int32_t add(std::span<const std::int32_t> sources, std::span<const double> weights);

    // Returns the middle of a quadrilateral of eight points, four corners and then the middles of
    // its edges, by the shape functions of serendipity elements (vtkQuadraticQuad): -1/4 and 1/2.
    // Two cells that share the face get one point; if they have copies of its points, each gets
    // one, at exactly the same place.
    std::int32_t middle_of(const std::array<std::int32_t, 8>& face);

    // Appends the values at the points that were made since the last call to each scalar at points.
    void append_values();

    static constexpr std::size_t most_points = 0x7fffffff;

  private:
    MeshData& mesh_;
    PointPlaces& places_;
    std::map<std::array<std::int32_t, 8>, std::int32_t> middles_;
    // Those since append_values(): point i has the sources ends_[i - 1] ... ends_[i] - 1.
    std::vector<std::int32_t> sources_;
    std::vector<double> weights_;
    std::vector<std::size_t> ends_;
};

// How readers treat cells of a VTK type.
enum class CellUse { straight, lattice, faces, refused };

// A type of cell with volume.
struct CellType {
    std::int64_t number;  // VTK's
    const char* name;     // for messages
    CellUse use;
    std::size_t points;     // in the file; 0: any number
    CellLattice lattice{};  // of types whose number of points is fixed; else only its shape counts
    const char* advice = nullptr;  // what to do about cells of a refused type
};

// Returns the description of a type, or null if it is unknown or has no volume.
const CellType* find_cell_type(std::int64_t number);

// Tells if cells of a type have no volume (vtkCellType.h: 0, 1 or 2 dimensions).
bool has_no_volume(std::int64_t type);

// The tets that one cell is cut into.
struct SplitCell {
    std::array<Tet, 6> tets;
    std::size_t count = 0;
};

// Cuts a hexahedron, voxel, wedge or pyramid into 6, 6, 3 or 2 tets (like Dompierre, Labbe, Vallet,
// Camarero, How to subdivide pyramids, prisms and hexahedra into tetrahedra, 1999, whose hexahedra
// sometimes have only five). Each quadrilateral face is cut along the diagonal through its least
// point index (or `places`, if given), so that neighbouring cells agree; then the cell's least
// point is joined to the triangles of the faces without it. Wedges may have either orientation.
// Other inverted cells give inverted tets, and repeated corners repeated ones. `type`: a VTK type
// with straight edges. `corners`: valid indices of `points`.
SplitCell split_cell(std::int64_t type, std::span<const std::int32_t> corners,
                     std::span<const glm::dvec3> points, const PointPlaces* places = nullptr);

// The faces of a polyhedron: face i has the points corners[ends[i - 1]] ... corners[ends[i] - 1].
struct PolyhedronFaces {
    std::vector<std::int32_t> corners;
    std::vector<std::size_t> ends;
};

// Returns the faces of VTK's prisms over a pentagon or a hexagon, of 10 or 12 points.
PolyhedronFaces faces_of_prism(std::span<const std::int32_t> points);

// Cuts cells into tets of a mesh, counts them in mesh.cells, and makes the points that this needs.
// Faces are cut by the places of their points alone, so that neighbours agree (docs/meshes.md).
class CellCuts {
  public:
    CellCuts(MeshData& mesh, PointPlaces& places)
        : mesh_(mesh), places_(places), made_(mesh, places) {}

    void add_straight(std::int64_t type, std::span<const std::int32_t> corners);

    // Adds a cell of higher order. Quadratic cells may lack the last points of their lattice.
    void add_lattice(const CellLattice& lattice, std::span<const std::int32_t> points);

    // Cuts each face into a fan around its point of least place and joins it to the mean of the
    // polyhedron's points. Faces may be listed in either sense.
    void add_polyhedron(const PolyhedronFaces& faces);

    MadePoints& made() { return made_; }

  private:
    void make_missing(const CellLattice& lattice, std::size_t given);
    void add_part(const SubCell& part);
    void add_octahedron(const std::array<std::int32_t, 8>& corners);
    void judge_curved(std::size_t first_tet, bool either_sense);

    MeshData& mesh_;
    PointPlaces& places_;
    MadePoints made_;
    std::map<std::pair<CellLattice, std::size_t>, std::vector<SubCell>> parts_;
    std::vector<std::int32_t> points_;  // of the cell that is being cut
};

}  // namespace lamina
