// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace lamina {

// VTK's numbers of straight cells (vtkCellType.h), and one of our own for the middle of a
// quadratic tet: vertices 0 and 5, 1 and 4, 2 and 3 of an octahedron lie opposite one another.
constexpr std::int64_t vtk_tetra = 10, vtk_voxel = 11, vtk_hexahedron = 12, vtk_wedge = 13,
                       vtk_pyramid = 14, vtk_polyhedron = 42, octahedron = -8;

// The points of a cell of higher order: a lattice with `order` intervals along each axis (a wedge's
// third axis goes from triangle to triangle). A pyramid has order 2. Starred cells are quadratic
// ones with a point in the middle of each face and of the cell: VTK's tets of 15, pyramids of 19
// and wedges of 21 points.
struct CellLattice {
    enum class Shape { tet, hexahedron, wedge, pyramid, starred };
    Shape shape = Shape::tet;
    std::array<int, 3> order{2, 2, 2};
    // Numbers the points of vertical edges 2 and 3 of a hexahedron as VTK did before version 9.
    bool old_numbers = false;

    std::size_t points() const;  // of all shapes but starred ones
    friend auto operator<=>(const CellLattice&, const CellLattice&) = default;
};

// Highest order that is read.
constexpr int highest_order = 10;

// Returns the lattice of a Lagrange cell with so many points, or nothing. `orders`: those along the
// three axes as the file says; empty: one order for all axes.
std::optional<CellLattice> lattice_with(CellLattice::Shape shape, std::size_t points,
                                        std::span<const double> orders);

// A part of a cell with straight edges; the corners are numbers of the cell's points.
struct SubCell {
    std::int64_t type = vtk_tetra;
    std::array<std::uint16_t, 8> corners{};
};

// Cuts a cell along its lattice: a tet of order n into n^3 tets (each octahedron stands for four of
// them), a hexahedron into hexahedra, a wedge into wedges, a quadratic pyramid into six pyramids
// and four tets. A starred cell's triangles are cut into six around their middle, quadrilaterals
// into four, and all are joined to the point inside. So neighbours of one order conform.
// `starred_points`: how many points a starred cell has.
std::vector<SubCell> cut_lattice(const CellLattice& lattice, std::size_t starred_points);

}  // namespace lamina
