// SPDX-License-Identifier: Apache-2.0
// The numbers of points are those of VTK's files: Index() and PointIndexFromIJK() of
// vtkHigherOrderTriangle, vtkHigherOrderTetra, vtkHigherOrderHexahedron and vtkHigherOrderWedge.
#include "mesh_files/cell_lattice.h"

#include <algorithm>
#include <span>

namespace lamina {
namespace {

using Shape = CellLattice::Shape;
using Ijk = std::array<int, 3>;

// Returns the number of a point of a triangle: its corners, then its edges, then the triangle
// inside, numbered likewise. `at`: coordinates in intervals, `order` at one corner, 0 opposite it.
int triangle_number(std::array<int, 3> at, int order) {
    if (order == 0) return 0;
    if (*std::ranges::min_element(at) > 0)
        return 3 * order + triangle_number({at[0] - 1, at[1] - 1, at[2] - 1}, order - 3);
    for (std::size_t corner = 0; corner < 3; ++corner)
        if (at[corner] == order) return static_cast<int>(corner);
    for (std::size_t edge = 0;; ++edge) {
        const int first = 3 + static_cast<int>(edge) * (order - 1);
        if (at[(edge + 2) % 3] == 0) return first + at[(edge + 1) % 3] - 1;
    }
}

// Returns the number of a point of a tet: corners, edges, faces, then the tet inside.
int tet_number(std::array<int, 4> at, int order) {
    constexpr std::size_t edges[][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
    constexpr std::size_t faces[][3] = {{0, 1, 3}, {2, 3, 1}, {0, 3, 2}, {0, 2, 1}};
    if (order == 0) return 0;
    int number = 0;
    if (*std::ranges::min_element(at) > 0) {
        for (int& coordinate : at) --coordinate;
        return 2 * (order * order + 1) + tet_number(at, order - 4);
    }
    for (const int coordinate : at) {
        if (coordinate == order) return number;
        ++number;
    }
    for (const auto& [a, b] : edges) {
        if (at[a] + at[b] == order) return number + at[b] - 1;
        number += order - 1;
    }
    for (const auto& [a, b, c] : faces) {
        if (at[a] + at[b] + at[c] == order)
            return number + triangle_number({at[a], at[b], at[c]}, order) - 3 * order;
        number += (order - 1) * (order - 2) / 2;
    }
    return number;
}

// Returns the number of a point of a hexahedron: corners, edges along the axes, faces, inside.
int hexahedron_number(const CellLattice& lattice, const Ijk& at) {
    const Ijk& n = lattice.order;
    std::array<bool, 3> inside{};
    for (std::size_t axis = 0; axis < 3; ++axis) inside[axis] = at[axis] > 0 && at[axis] < n[axis];
    const auto [i, j, k] = at;
    const int x = n[0] - 1, y = n[1] - 1, z = n[2] - 1;  // points inside of an edge
    switch (std::ranges::count(inside, true)) {
        case 0:
            return (i > 0 ? (j > 0 ? 2 : 1) : (j > 0 ? 3 : 0)) + (k > 0 ? 4 : 0);
        case 1: {
            const int top = 8 + (k > 0 ? 2 * (x + y) : 0);
            if (inside[0]) return top + (j > 0 ? x + y : 0) + i - 1;
            if (inside[1]) return top + (i > 0 ? x : 2 * x + y) + j - 1;
            const int far = lattice.old_numbers ? 3 : 2, left = lattice.old_numbers ? 2 : 3;
            return 8 + 4 * (x + y) + z * (i > 0 ? (j > 0 ? far : 1) : (j > 0 ? left : 0)) + k - 1;
        }
        case 2: {
            const int first = 8 + 4 * (x + y + z);
            if (!inside[0]) return first + (i > 0 ? y * z : 0) + j - 1 + y * (k - 1);
            if (!inside[1]) return first + 2 * y * z + (j > 0 ? x * z : 0) + i - 1 + x * (k - 1);
            return first + 2 * z * (x + y) + (k > 0 ? x * y : 0) + i - 1 + x * (j - 1);
        }
        default:
            return 8 + 4 * (x + y + z) + 2 * (y * z + x * z + x * y) + i - 1 +
                   x * (j - 1 + y * (k - 1));
    }
}

// Returns the number of a point of a wedge: corners, edges of the triangles, edges between them,
// triangles, quadrilaterals, inside.
int wedge_number(const CellLattice& lattice, const Ijk& at) {
    const auto [i, j, k] = at;
    const int n = lattice.order[0], x = n - 1, z = lattice.order[2] - 1;
    const int layer = x * (n - 2) / 2;  // points inside of a triangle
    const bool end = k == 0 || k == lattice.order[2];
    const int side = j == 0 ? 0 : i + j == n ? 1 : 2;  // an edge of the triangle, if `at` is on one
    const bool on_side = i == 0 || j == 0 || i + j == n;
    const bool corner = i == n || j == n || i + j == 0;
    const int which = i == n ? 1 : j == n ? 2 : 0;
    if (corner && end) return which + (k > 0 ? 3 : 0);
    if (corner) return 6 + 6 * x + which * z + k - 1;
    if (on_side && end)
        return 6 + ((k > 0 ? 3 : 0) + side) * x + (side == 0 ? i : side == 1 ? j : n - j) - 1;
    const int faces = 6 + 6 * x + 3 * z;
    const int in_layer = i - 1 + n * (j - 1) - (j * (j + 1)) / 2 + 1;
    if (end) return faces + (k > 0 ? layer : 0) + in_layer;
    if (on_side)
        return faces + 2 * layer + side * x * z + (side == 0 ? i : n - (side == 1 ? i : j)) - 1 +
               x * (k - 1);
    return faces + 2 * layer + 3 * x * z + in_layer + layer * (k - 1);
}

int number_at(const CellLattice& lattice, const Ijk& at) {
    const int n = lattice.order[0];
    if (lattice.shape == Shape::tet)
        return tet_number({n - at[0] - at[1] - at[2], at[0], at[1], at[2]}, n);
    return lattice.shape == Shape::wedge ? wedge_number(lattice, at)
                                         : hexahedron_number(lattice, at);
}

// A part of a lattice's cell at the place (i, j, k), if `left` intervals are left there up to the
// slanted side of a tet or wedge. `steps`: from there to the part's corners.
struct LatticePart {
    Shape shape;
    int left;
    std::int64_t type;
    std::size_t corners;
    Ijk steps[8];
};
constexpr LatticePart lattice_parts[] = {
    {Shape::tet, 1, vtk_tetra, 4, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
    {Shape::tet,
     2,
     octahedron,
     6,
     {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {1, 0, 1}, {0, 1, 1}}},
    {Shape::tet, 3, vtk_tetra, 4, {{1, 1, 0}, {0, 1, 1}, {1, 0, 1}, {1, 1, 1}}},
    {Shape::hexahedron,
     0,
     vtk_hexahedron,
     8,
     {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}},
    {Shape::wedge,
     1,
     vtk_wedge,
     6,
     {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}}},
    {Shape::wedge,
     2,
     vtk_wedge,
     6,
     {{1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}}};

void add_parts_at(const CellLattice& lattice, const Ijk& at, std::vector<SubCell>& parts) {
    const int left = lattice.order[0] - at[0] - at[1] - (lattice.shape == Shape::tet ? at[2] : 0);
    for (const LatticePart& part : lattice_parts) {
        if (part.shape != lattice.shape || (part.left > 0 && left < part.left)) continue;
        SubCell& cell = parts.emplace_back(SubCell{part.type, {}});
        for (std::size_t c = 0; c < part.corners; ++c) {
            const Ijk& step = part.steps[c];
            cell.corners[c] = static_cast<std::uint16_t>(
                number_at(lattice, {at[0] + step[0], at[1] + step[1], at[2] + step[2]}));
        }
    }
}

// Point 13 is the middle of the base; 9 to 12 are the middles of the edges to the apex, 4.
std::vector<SubCell> cut_pyramid() {
    return {{vtk_pyramid, {0, 5, 13, 8, 9}},   {vtk_pyramid, {5, 1, 6, 13, 10}},
            {vtk_pyramid, {13, 6, 2, 7, 11}},  {vtk_pyramid, {8, 13, 7, 3, 12}},
            {vtk_pyramid, {9, 10, 11, 12, 4}}, {vtk_pyramid, {9, 12, 11, 10, 13}},
            {vtk_tetra, {5, 13, 9, 10}},       {vtk_tetra, {6, 13, 10, 11}},
            {vtk_tetra, {7, 13, 11, 12}},      {vtk_tetra, {8, 13, 12, 9}}};
}

// The points around a face, corners and middles of edges in turn, outward, then its middle.
using Triangle = std::array<std::uint16_t, 7>;
using Quadrilateral = std::array<std::uint16_t, 9>;
// vtkHigherOrderTetra (15 points), vtkTriQuadraticPyramid, vtkHigherOrderWedge (21 points).
constexpr Triangle tet_triangles[] = {
    {0, 6, 2, 5, 1, 4, 10}, {0, 4, 1, 8, 3, 7, 11}, {1, 5, 2, 9, 3, 8, 12}, {2, 6, 0, 7, 3, 9, 13}};
constexpr Triangle pyramid_triangles[] = {{0, 5, 1, 10, 4, 9, 14},
                                          {1, 6, 2, 11, 4, 10, 15},
                                          {2, 7, 3, 12, 4, 11, 16},
                                          {3, 8, 0, 9, 4, 12, 17}};
constexpr Quadrilateral pyramid_base[] = {{0, 8, 3, 7, 2, 6, 1, 5, 13}};
constexpr Triangle wedge_triangles[] = {{0, 8, 2, 7, 1, 6, 15}, {3, 9, 4, 10, 5, 11, 16}};
constexpr Quadrilateral wedge_sides[] = {{0, 6, 1, 13, 4, 9, 3, 12, 17},
                                         {1, 7, 2, 14, 5, 10, 4, 13, 18},
                                         {2, 8, 0, 12, 3, 11, 5, 14, 19}};

std::vector<SubCell> star(std::span<const Triangle> triangles,
                          std::span<const Quadrilateral> quadrilaterals, std::uint16_t inside) {
    std::vector<SubCell> parts;
    for (const Triangle& face : triangles) {
        for (std::size_t i = 0; i < 6; ++i)
            parts.push_back({vtk_tetra, {inside, face[i], face[(i + 1) % 6], face[6]}});
    }
    for (const Quadrilateral& face : quadrilaterals) {
        for (std::size_t i = 0; i < 8; i += 2) {  // a pyramid's base faces its apex
            parts.push_back(
                {vtk_pyramid, {face[i], face[(i + 7) % 8], face[8], face[(i + 1) % 8], inside}});
        }
    }
    return parts;
}

}  // namespace

std::size_t CellLattice::points() const {
    const auto [x, y, z] = order;
    switch (shape) {
        case Shape::tet:
            return static_cast<std::size_t>((x + 1) * (x + 2) * (x + 3) / 6);
        case Shape::wedge:
            return static_cast<std::size_t>((x + 1) * (x + 2) / 2 * (z + 1));
        case Shape::pyramid:
            return x == 1 ? 5 : 14;
        default:
            return static_cast<std::size_t>((x + 1) * (y + 1) * (z + 1));
    }
}

std::optional<CellLattice> lattice_with(CellLattice::Shape shape, std::size_t points,
                                        std::span<const double> orders) {
    const bool quadratic = orders.empty() || std::ranges::count(orders, 2) == 3;
    if (quadratic &&
        ((shape == Shape::tet && points == 15) || (shape == Shape::wedge && points == 21) ||
         (shape == Shape::pyramid && points == 19)))
        return CellLattice{Shape::starred};
    if (shape == Shape::pyramid && points == 13) return CellLattice{Shape::pyramid};
    if (shape != Shape::pyramid && !orders.empty()) {
        CellLattice told{shape};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (!(orders[axis] >= 1 && orders[axis] <= highest_order)) return std::nullopt;
            told.order[axis] = static_cast<int>(orders[axis]);
        }
        const auto [x, y, z] = told.order;
        const bool fits =
            shape == Shape::hexahedron || (x == y && (shape == Shape::wedge || y == z));
        return fits && told.points() == points ? std::optional(told) : std::nullopt;
    }
    const int highest = shape == Shape::pyramid ? 2 : highest_order;
    for (int n = 1; n <= highest; ++n) {
        const CellLattice lattice{shape, {n, n, n}};
        if (lattice.points() == points) return lattice;
    }
    return std::nullopt;
}

std::vector<SubCell> cut_lattice(const CellLattice& lattice, std::size_t starred_points) {
    if (lattice.shape == Shape::pyramid) return cut_pyramid();
    if (lattice.shape == Shape::starred) {
        if (starred_points == 15) return star(tet_triangles, {}, 14);
        if (starred_points == 19) return star(pyramid_triangles, pyramid_base, 18);
        return star(wedge_triangles, wedge_sides, 20);
    }
    std::vector<SubCell> parts;
    for (int k = 0; k < lattice.order[2]; ++k)
        for (int j = 0; j < lattice.order[1]; ++j)
            for (int i = 0; i < lattice.order[0]; ++i) add_parts_at(lattice, {i, j, k}, parts);
    return parts;
}

}  // namespace lamina
