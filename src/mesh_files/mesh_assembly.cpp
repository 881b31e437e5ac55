// SPDX-License-Identifier: Apache-2.0
#include "mesh_files/mesh_assembly.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <string_view>

#include "base/client.h"
#include "base/error.h"

namespace lamina {
namespace {

void check_ends(const MeshPiece& piece) {
    const auto& ends = piece.cells.ends;
    std::int64_t begin = 0;
    for (std::size_t cell = 0; cell < ends.size(); ++cell) {
        if (ends[cell] < begin) {
            fail("{}: offsets: found {} for cell {} after {}, expected no less", piece.label,
                 ends[cell], cell, begin);
        }
        begin = ends[cell];
    }
    if (begin != static_cast<std::int64_t>(piece.cells.connectivity.size())) {
        fail("{}: connectivity: found {} indices, the cells' offsets end at {}", piece.label,
             piece.cells.connectivity.size(), begin);
    }
}

// Stands for the index of a point that its file hides.
constexpr std::int32_t hidden_index = -1;

// Returns a piece's point as an index into the points of the whole mesh.
std::int32_t index_in(const MeshPiece& piece, std::size_t cell, std::int64_t index,
                      std::span<const std::int32_t> indices) {
    if (index < 0 || index >= static_cast<std::int64_t>(indices.size())) {
        fail("{}: cell {} (the first is 0): found point index {}, expected 0 to {}", piece.label,
             cell, index, static_cast<std::int64_t>(indices.size()) - 1);
    }
    return indices[static_cast<std::size_t>(index)];
}

std::span<const std::int64_t> listed_points(const MeshPiece& piece, std::size_t cell) {
    const std::int64_t begin = cell == 0 ? 0 : piece.cells.ends[cell - 1];
    return std::span(piece.cells.connectivity)
        .subspan(static_cast<std::size_t>(begin),
                 static_cast<std::size_t>(piece.cells.ends[cell] - begin));
}

// Sets `points` to those of a cell, as indices into the points of the whole mesh.
void read_points(const MeshPiece& piece, std::size_t cell, const CellType& type,
                 std::span<const std::int32_t> indices, std::vector<std::int32_t>& points) {
    points.clear();
    for (const std::int64_t index : listed_points(piece, cell))
        points.push_back(index_in(piece, cell, index, indices));
    if (type.points == 0 || points.size() == type.points) return;
    fail("{}: cell {} (the first is 0), a {}: found {} points, expected {}", piece.label, cell,
         type.name, points.size(), type.points);
}

// Reads a polyhedron's face stream: the number of faces, then each face's points and their number.
PolyhedronFaces read_faces(const MeshPiece& piece, std::size_t cell,
                           std::span<const std::int32_t> indices,
                           std::span<const std::int64_t> stream) {
    const auto check = [&](const char* what, std::int64_t found, std::int64_t least) {
        if (found >= least && found <= std::ssize(stream)) return;
        fail(
            "{}: cell {} (the first is 0), a polyhedron: {}: found {}, expected at least {}, and "
            "no "
            "more than its list of {} numbers has",
            piece.label, cell, what, found, least, stream.size());
    };
    constexpr std::int64_t least_faces = 4, least_corners = 3;
    const std::int64_t count = stream.empty() ? 0 : stream[0];
    check("number of faces", count, least_faces);
    PolyhedronFaces faces;
    std::size_t at = 1;
    for (std::int64_t face = 0; face < count; ++face) {
        const std::int64_t corners = at < stream.size() ? stream[at] : 0;
        check("points of a face", corners, least_corners);
        check("numbers up to the end of a face", static_cast<std::int64_t>(at) + corners + 1, 0);
        for (const std::int64_t index : stream.subspan(at + 1, static_cast<std::size_t>(corners)))
            faces.corners.push_back(index_in(piece, cell, index, indices));
        faces.ends.push_back(faces.corners.size());
        at += static_cast<std::size_t>(corners) + 1;
    }
    return faces;
}

// Returns the scalars of a piece, `more`, in the order of those of the pieces before it, `all`.
std::vector<const MeshScalar*> matched(const std::vector<MeshScalar>& all,
                                       const std::vector<MeshScalar>& more, const MeshPiece& piece,
                                       const char* kind) {
    if (more.size() != all.size()) {
        fail("{}: found {} scalars in its {}, expected {} as in the pieces before", piece.label,
             more.size(), kind, all.size());
    }
    // Arrays with equal names are matched in their order.
    std::multimap<std::string_view, const MeshScalar*> by_name;
    for (const MeshScalar& scalar : more) by_name.emplace(scalar.name, &scalar);
    std::vector<const MeshScalar*> found;
    for (const MeshScalar& scalar : all) {
        const auto same = by_name.lower_bound(scalar.name);
        if (same == by_name.end() || same->first != scalar.name) {
            fail("{}: no array '{}' in its {}, which the pieces before have", piece.label,
                 one_line(scalar.name), kind);
        }
        found.push_back(same->second);
        by_name.erase(same);
    }
    return found;
}

// Removes the arrays that mark ghosts. Returns which of `count` cells or points they hide. `bits`:
// those of vtkGhostType that hide; levels (of cells only) hide if they are not 0.
std::vector<bool> take_ghosts(std::vector<MeshScalar>& scalars, std::size_t count, int bits) {
    std::vector<bool> ghosts(count, false);
    std::erase_if(scalars, [&](const MeshScalar& scalar) {
        const bool levels = scalar.name == "vtkGhostLevels";
        if (!levels && scalar.name != "vtkGhostType") return false;
        for (std::size_t i = 0; i < count; ++i) {
            const double value = scalar.values[i];
            if (!(value > 0 && value < 256)) continue;
            if (levels ? bits == vtk_hidden_cell : (static_cast<int>(value) & bits) != 0)
                ghosts[i] = true;
        }
        return true;
    });
    return ghosts;
}

// Returns the lattice of a Lagrange cell of `count` points.
CellLattice lagrange_lattice(const MeshPiece& piece, std::size_t cell, const CellType& type,
                             std::size_t count) {
    const auto orders = piece.orders.empty() ? std::span<const double>()
                                             : std::span(piece.orders).subspan(3 * cell, 3);
    auto lattice = lattice_with(type.lattice.shape, count, orders);
    if (!lattice) {
        const bool pyramid = type.lattice.shape == CellLattice::Shape::pyramid;
        fail(
            "{}: cell {} (the first is 0), a {}: found {} points, expected those of an order from "
            "1 to {}{}",
            piece.label, cell, type.name, count, pyramid ? 2 : highest_order,
            orders.empty() ? "" : ", or of the orders in its HigherOrderDegrees");
    }
    lattice->old_numbers = type.number == 72 && piece.old_hexahedra;
    return *lattice;
}

bool same(double a, double b) {
    return a == b || (std::isnan(a) && std::isnan(b));
}

}  // namespace

std::vector<glm::dvec3> points_from_values(const std::vector<double>& values) {
    std::vector<glm::dvec3> points(values.size() / 3);
    for (std::size_t i = 0; i < points.size(); ++i) {
        points[i] = {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
    }
    return points;
}

void add_scalars(std::vector<MeshScalar>& scalars, const std::string& name, std::int64_t components,
                 std::vector<double> values) {
    if (components == 1) {
        scalars.push_back({name, std::move(values)});
        return;
    }
    const std::size_t count = values.size() / 3;
    std::vector<double> lengths(count);
    for (std::size_t i = 0; i < count; ++i)
        lengths[i] = std::hypot(values[3 * i], values[3 * i + 1], values[3 * i + 2]);
    scalars.push_back({name, std::move(lengths)});
    for (std::size_t axis = 0; axis < 3; ++axis) {
        std::vector<double> component(count);
        for (std::size_t i = 0; i < count; ++i) component[i] = values[3 * i + axis];
        scalars.push_back({name + "." + "xyz"[axis], std::move(component)});
    }
}

// Tells if cells of a type are cut by the places of their points. Tets of any order are not.
bool is_cut(std::int64_t type) {
    constexpr std::int64_t tets[] = {vtk_tetra, 24, 71};
    return std::ranges::count(tets, type) == 0 && find_cell_type(type) != nullptr;
}

// Adds those points of a piece that the mesh lacks, with their values. Returns each point's index
// in the mesh. `scalars`: the piece's scalars in the order of the mesh's.
std::vector<std::int32_t> MeshAssembly::add_points(const MeshPiece& piece,
                                                   std::span<const MeshScalar* const> scalars) {
    const auto equal_values = [&](std::size_t point, std::size_t index) {
        for (std::size_t s = 0; s < scalars.size(); ++s) {
            if (!same(scalars[s]->values[point], mesh_.point_scalars[s].values[index]))
                return false;
        }
        return true;
    };
    std::vector<std::int32_t> indices(piece.points.size(), -1);
    if (!mesh_.points.empty()) {
        places_.look();
        PointPlaces own(piece.points);
        own.look();
        for (std::size_t i = 0; i < indices.size(); ++i) {
            if ((i & 0xfffff) == 0) check_interrupt();
            if (own.table().find(piece.points[i]) < 0) continue;
            const std::int32_t index = places_.table().find(piece.points[i]);
            if (index >= 0 && equal_values(i, static_cast<std::size_t>(index))) indices[i] = index;
        }
    }
    const auto merged = static_cast<std::size_t>(
        std::ranges::count_if(indices, [](std::int32_t index) { return index >= 0; }));
    const std::size_t total = mesh_.points.size() + piece.points.size() - merged;
    if (total > MadePoints::most_points) {
        fail("{}: found {} points, expected at most {}", piece.label, total,
             MadePoints::most_points);
    }
    mesh_.cells.merged_points += static_cast<std::int64_t>(merged);
    if (mesh_.points.empty()) mesh_.points.reserve(total);
    for (std::size_t i = 0; i < indices.size(); ++i) {
        if (indices[i] >= 0) continue;
        indices[i] = static_cast<std::int32_t>(mesh_.points.size());
        mesh_.points.push_back(piece.points[i]);
        for (std::size_t s = 0; s < scalars.size(); ++s)
            mesh_.point_scalars[s].values.push_back(scalars[s]->values[i]);
    }
    if (places_.known() || std::ranges::any_of(piece.cells.types, is_cut)) places_.look();
    return indices;
}

// Returns the face stream of a cell. `begin`: where that of the next one begins, in piece.faces.
std::span<const std::int64_t> face_stream(const MeshPiece& piece, std::size_t cell,
                                          std::int64_t& begin) {
    const MeshCells& cells = piece.cells;
    if (cells.face_ends.empty()) return listed_points(piece, cell);
    const std::int64_t from = begin, end = cells.face_ends[cell];
    if (end < 0) return {};  // -1: the cell is no polyhedron
    if (end < from || end > std::ssize(cells.faces)) {
        fail("{}: faceoffsets: found {} for cell {}, expected {} to {}", piece.label, end, cell,
             from, cells.faces.size());
    }
    begin = end;
    return std::span(cells.faces)
        .subspan(static_cast<std::size_t>(from), static_cast<std::size_t>(end - from));
}

// Adds the tets of a piece's cells. Returns the number of the cell from which each tet was cut.
std::vector<std::int64_t> MeshAssembly::add_cells(const MeshPiece& piece,
                                                  const std::vector<bool>& ghosts,
                                                  std::span<const std::int32_t> indices) {
    std::vector<std::int64_t> cell_of_tet;
    cell_of_tet.reserve(piece.cells.types.size());
    // Reserves for the first piece only: with many small ones, each would reallocate the vector.
    const std::size_t tets_before = mesh_.tets.size();
    if (tets_before == 0) mesh_.tets.reserve(piece.cells.types.size());
    std::vector<std::int32_t> points;
    std::int64_t face_begin = 0;
    for (std::size_t cell = 0; cell < piece.cells.types.size(); ++cell) {
        if ((cell & 0xffff) == 0) check_interrupt();
        const std::int64_t number = piece.cells.types[cell];
        const auto faces = number == vtk_polyhedron ? face_stream(piece, cell, face_begin)
                                                    : std::span<const std::int64_t>();
        if (ghosts[cell] || has_no_volume(number)) {
            ++(ghosts[cell] ? mesh_.cells.ghosts : mesh_.cells.skipped);
            continue;
        }
        const CellType* const type = find_cell_type(number);
        if (type == nullptr || type->use == CellUse::refused) {
            fail(
                "{}: cell {} (the first is 0): found a {} (VTK cell type {}), which is not read: "
                "{}",
                piece.label, cell, type == nullptr ? "cell of an unknown type" : type->name, number,
                type == nullptr ? "expected one that docs/meshes.md names" : type->advice);
        }
        PolyhedronFaces polyhedron;
        if (number == vtk_polyhedron)
            polyhedron = read_faces(piece, cell, indices, faces);
        else
            read_points(piece, cell, *type, indices, points);
        const auto& used = number == vtk_polyhedron ? polyhedron.corners : points;
        if (std::ranges::count(used, hidden_index) > 0)
            ++mesh_.cells.ghosts;
        else if (number == vtk_polyhedron)
            cuts_.add_polyhedron(polyhedron);
        else if (type->use == CellUse::faces)
            cuts_.add_polyhedron(faces_of_prism(points));
        else if (type->use == CellUse::straight)
            cuts_.add_straight(number, points);
        else if (type->points > 0)
            cuts_.add_lattice(type->lattice, points);
        else
            cuts_.add_lattice(lagrange_lattice(piece, cell, *type, points.size()), points);
        cell_of_tet.resize(mesh_.tets.size() - tets_before, static_cast<std::int64_t>(cell));
    }
    return cell_of_tet;
}

// Notes from which cell each tet was cut, for means of cell data.
void MeshAssembly::number_cells(const std::vector<std::int64_t>& cell_of_tet) {
    std::int64_t last = -1;
    for (const std::int64_t cell : cell_of_tet) {
        if (cell != last) ++cells_;
        last = cell;
        mesh_.cell_of_tet.push_back(static_cast<std::int32_t>(cells_ - 1));
    }
}

void MeshAssembly::add(MeshPiece piece) {
    if (piece.points.empty() && piece.cells.types.empty()) return;
    check_ends(piece);
    const std::vector<bool> hidden =
        take_ghosts(piece.point_scalars, piece.points.size(), vtk_hidden_point);
    const std::vector<bool> ghosts =
        take_ghosts(piece.cell_scalars, piece.cells.types.size(), vtk_hidden_cell);
    near_.take(piece.points);
    std::vector<const MeshScalar*> scalars;
    if (!first_) scalars = matched(mesh_.point_scalars, piece.point_scalars, piece, "point data");
    const std::vector<std::int32_t> indices = add_points(piece, scalars);
    std::vector<std::int32_t> visible = indices;
    for (std::size_t i = 0; i < visible.size(); ++i)
        if (hidden[i]) visible[i] = hidden_index;
    const std::vector<std::int64_t> cell_of_tet = add_cells(piece, ghosts, visible);
    if (!piece.cell_scalars.empty()) number_cells(cell_of_tet);
    for (MeshScalar& scalar : piece.cell_scalars) {
        std::vector<double> of_tets(cell_of_tet.size());
        for (std::size_t tet = 0; tet < of_tets.size(); ++tet) {
            of_tets[tet] = scalar.values[static_cast<std::size_t>(cell_of_tet[tet])];
        }
        scalar.values = std::move(of_tets);
    }
    if (first_) mesh_.point_scalars = std::move(piece.point_scalars);
    cuts_.made().append_values();
    if (first_) {
        mesh_.cell_scalars = std::move(piece.cell_scalars);
    } else {
        const auto more = matched(mesh_.cell_scalars, piece.cell_scalars, piece, "cell data");
        for (std::size_t i = 0; i < more.size(); ++i) {
            std::vector<double>& values = mesh_.cell_scalars[i].values;
            values.insert(values.end(), more[i]->values.begin(), more[i]->values.end());
        }
    }
    first_ = false;
}

MeshData MeshAssembly::finish() {
    if (mesh_.points.empty()) fail("{}: found no points", file_);
    if (mesh_.tets.empty() && mesh_.cells.ghosts > 0) {
        fail("{}: found {} ghost cells, which other pieces have, expected cells of its own", file_,
             mesh_.cells.ghosts);
    }
    if (mesh_.tets.empty() && mesh_.cells.skipped > 0) {
        fail(
            "{}: found {} cells, all without volume, expected tetrahedra, hexahedra, wedges or "
            "pyramids",
            file_, mesh_.cells.skipped);
    }
    if (mesh_.tets.empty()) fail("{}: found no cells", file_);
    if (near_.moved() > 0) {
        say("{}: mesh.join: {} points took the place of an earlier one, up to {:.3g} "
            "away",
            file_, near_.moved(), near_.farthest());
    }
    if (mesh_.cells.split + mesh_.cells.straightened == 0) mesh_.cell_of_tet = {};
    return std::move(mesh_);
}

}  // namespace lamina
