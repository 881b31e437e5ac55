// SPDX-License-Identifier: Apache-2.0
#include "mesh_files/mesh_assembly.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <iterator>
#include <limits>
#include <map>
#include <string_view>

#include "base/client.h"
#include "base/error.h"

namespace lamina {
namespace {

constexpr std::int64_t tetra = 10, voxel = 11, hexahedron = 12, wedge = 13, pyramid = 14;

// Most points of a cell type that is read: those of a triquadratic hexahedron.
constexpr std::size_t most_cell_points = 27;

// A type of cell with volume. Only the corners of a quadratic cell are used, which come first: it
// is straightened to the cell of type `straight`.
struct CellType {
    std::int64_t number;  // VTK's
    const char* name;     // for messages
    std::size_t points;   // in the file
    std::size_t corners;  // the first of these
    std::int64_t straight;
};
// vtkCellType.h; the corners of each come first (vtkQuadraticHexahedron.h and so on).
constexpr CellType types[] = {
    {tetra, "tetrahedron", 4, 4, tetra},
    {voxel, "voxel", 8, 8, voxel},
    {hexahedron, "hexahedron", 8, 8, hexahedron},
    {wedge, "wedge", 6, 6, wedge},
    {pyramid, "pyramid", 5, 5, pyramid},
    {24, "quadratic tetrahedron", 10, 4, tetra},
    {25, "quadratic hexahedron", 20, 8, hexahedron},
    {26, "quadratic wedge", 15, 6, wedge},
    {27, "quadratic pyramid", 13, 5, pyramid},
    {29, "triquadratic hexahedron", most_cell_points, 8, hexahedron},
    {31, "quadratic linear wedge", 12, 6, wedge},
    {32, "biquadratic quadratic wedge", 18, 6, wedge},
    {33, "biquadratic quadratic hexahedron", 24, 8, hexahedron},
    {37, "triquadratic pyramid", 19, 5, pyramid},
};

const CellType* find_type(std::int64_t number) {
    const auto* const found = std::ranges::find(types, number, &CellType::number);
    return found == std::end(types) ? nullptr : found;
}

// Corners of a face, counter-clockwise seen from outside; a triangle has 3, then `no_corner`.
constexpr std::size_t no_corner = 8;
using Face = std::array<std::size_t, 4>;

constexpr Face hexahedron_faces[] = {{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4},
                                     {3, 7, 6, 2}, {0, 3, 2, 1}, {4, 5, 6, 7}};
constexpr Face wedge_faces[] = {
    {0, 1, 2, no_corner}, {3, 5, 4, no_corner}, {0, 3, 4, 1}, {1, 4, 5, 2}, {2, 5, 3, 0}};
constexpr Face pyramid_faces[] = {{0, 3, 2, 1},
                                  {0, 1, 4, no_corner},
                                  {1, 2, 4, no_corner},
                                  {2, 3, 4, no_corner},
                                  {3, 0, 4, no_corner}};

std::span<const Face> faces_of(std::int64_t type) {
    if (type == wedge) return wedge_faces;
    if (type == pyramid) return pyramid_faces;
    return hexahedron_faces;
}

// Joins the cell's point of least index to the triangles of the faces without it (split_cell()).
SplitCell join_least_point(std::span<const Face> faces, std::span<const std::int32_t> corners) {
    const auto index = [&](std::size_t corner) { return corners[corner]; };
    const auto apex = static_cast<std::size_t>(std::min_element(corners.begin(), corners.end()) -
                                               corners.begin());
    SplitCell cell;
    const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
        cell.tets[cell.count++] = {index(apex), index(a), index(b), index(c)};
    };
    for (const Face& face : faces) {
        if (std::find(face.begin(), face.end(), apex) != face.end()) continue;
        if (face[3] == no_corner) {
            add(face[0], face[1], face[2]);
            continue;
        }
        std::size_t least = 0;
        for (std::size_t i = 1; i < 4; ++i) {
            if (index(face[i]) < index(face[least])) least = i;
        }
        const auto corner = [&](std::size_t i) { return face[(least + i) % 4]; };
        add(corner(0), corner(1), corner(2));
        add(corner(0), corner(2), corner(3));
    }
    return cell;
}

double volume(const Tet& tet, std::span<const glm::dvec3> points) {
    const auto point = [&](std::size_t i) { return points[static_cast<std::size_t>(tet[i])]; };
    return glm::dot(glm::cross(point(1) - point(0), point(2) - point(0)), point(3) - point(0)) / 6;
}

}  // namespace

CellUse use_of_cell(std::int64_t type) {
    if (const CellType* const cell = find_type(type))
        return cell->straight == tetra ? CellUse::tet : CellUse::split;
    // vtkCellType.h: all types of 0, 1 and 2 dimensions up to VTK 9.
    constexpr std::int64_t without_volume[] = {0,  1,  2,  3,  4,  5,  6,  7,  8,  9,  21,
                                               22, 23, 28, 30, 34, 35, 36, 51, 52, 53, 54,
                                               60, 61, 62, 63, 68, 69, 70, 75, 76, 77};
    return std::ranges::count(without_volume, type) > 0 ? CellUse::skip : CellUse::unsupported;
}

SplitCell split_cell(std::int64_t type, std::span<const std::int32_t> corners,
                     std::span<const glm::dvec3> points) {
    assert(use_of_cell(type) == CellUse::split && corners.size() == find_type(type)->points);
    std::array<std::int32_t, 8> order{};
    std::copy(corners.begin(), corners.end(), order.begin());
    if (type == voxel) {  // its corners lie in the order of the axes
        std::swap(order[2], order[3]);
        std::swap(order[6], order[7]);
    }
    SplitCell cell = join_least_point(faces_of(type), std::span(order).first(corners.size()));
    if (type == wedge) {
        double sum = 0;
        for (std::size_t i = 0; i < cell.count; ++i) sum += volume(cell.tets[i], points);
        for (std::size_t i = 0; sum < 0 && i < cell.count; ++i) {
            std::swap(cell.tets[i][2], cell.tets[i][3]);
        }
    }
    return cell;
}

namespace {

bool has_nan(const glm::dvec3& place) {
    return std::isnan(place.x) || std::isnan(place.y) || std::isnan(place.z);
}

// splitmix64 over the bits of each coordinate.
std::uint64_t hash_of(const glm::dvec3& place) {
    std::uint64_t hash = 0;
    for (const double coordinate : {place.x, place.y, place.z}) {
        hash +=
            std::bit_cast<std::uint64_t>(coordinate + 0.0) + 0x9e3779b97f4a7c15;  // -0 becomes 0
        hash = (hash ^ hash >> 30) * 0xbf58476d1ce4e5b9;
        hash = (hash ^ hash >> 27) * 0x94d049bb133111eb;
        hash ^= hash >> 31;
    }
    return hash;
}

constexpr std::size_t most_points = std::numeric_limits<std::int32_t>::max();

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

// Returns the corners of a cell as indices into the points of the whole mesh. The other points of a
// quadratic cell are not used, but an index of theirs that is out of range means a damaged file.
std::span<const std::int32_t> corners_of(const MeshPiece& piece, std::size_t cell,
                                         std::span<const std::int32_t> indices,
                                         std::array<std::int32_t, most_cell_points>& corners) {
    const std::int64_t begin = cell == 0 ? 0 : piece.cells.ends[cell - 1];
    const auto found = static_cast<std::size_t>(piece.cells.ends[cell] - begin);
    const CellType& type = *find_type(piece.cells.types[cell]);
    if (found != type.points) {
        fail("{}: cell {} (the first is 0), a {}: found {} points, expected {}", piece.label, cell,
             type.name, found, type.points);
    }
    for (std::size_t i = 0; i < found; ++i) {
        const std::int64_t index = piece.cells.connectivity[static_cast<std::size_t>(begin) + i];
        if (index < 0 || index >= static_cast<std::int64_t>(piece.points.size())) {
            fail("{}: cell {} (the first is 0): found point index {}, expected 0 to {}",
                 piece.label, cell, index, static_cast<std::int64_t>(piece.points.size()) - 1);
        }
        corners[i] = indices[static_cast<std::size_t>(index)];
    }
    return std::span(corners).first(type.corners);
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

// vtkDataSetAttributes.h: DUPLICATECELL, REFINEDCELL, HIDDENCELL.
constexpr int hiding_bits = 1 | 8 | 32;

// Removes the arrays that mark ghost cells (or points). Returns which of `count` cells they mark.
std::vector<bool> take_ghosts(std::vector<MeshScalar>& scalars, std::size_t count) {
    std::vector<bool> ghosts(count, false);
    std::erase_if(scalars, [&](const MeshScalar& scalar) {
        const bool levels = scalar.name == "vtkGhostLevels";
        if (!levels && scalar.name != "vtkGhostType") return false;
        for (std::size_t i = 0; i < count; ++i) {
            const double value = scalar.values[i];
            if (!(value > 0 && value < 256)) continue;
            if (levels || (static_cast<int>(value) & hiding_bits) != 0) ghosts[i] = true;
        }
        return true;
    });
    return ghosts;
}

bool same(double a, double b) {
    return a == b || (std::isnan(a) && std::isnan(b));
}

}  // namespace

// Returns the slot that has this place, or the empty one to which it belongs.
std::size_t PointTable::slot_of(const glm::dvec3& place) const {
    const std::size_t mask = slots_.size() - 1;
    std::size_t slot = hash_of(place) & mask;
    while (slots_[slot] != 0 &&
           points_[static_cast<std::size_t>(std::abs(slots_[slot]) - 1)] != place) {
        slot = (slot + 1) & mask;
    }
    return slot;
}

void PointTable::grow(std::size_t slots) {
    std::vector<std::int32_t> old(slots, 0);
    old.swap(slots_);
    for (const std::int32_t entry : old) {
        if (entry == 0) continue;
        slots_[slot_of(points_[static_cast<std::size_t>(std::abs(entry) - 1)])] = entry;
    }
}

void PointTable::add(std::int32_t point) {
    const glm::dvec3& place = points_[static_cast<std::size_t>(point)];
    if (has_nan(place)) return;
    if (2 * (used_ + 1) > slots_.size()) grow(slots_.empty() ? 64 : 2 * slots_.size());
    std::int32_t& entry = slots_[slot_of(place)];
    used_ += entry == 0;
    entry = entry == 0 ? point + 1 : -std::abs(entry);
}

void PointTable::add_all() {
    if (2 * (used_ + points_.size()) > slots_.size())
        grow(std::bit_ceil(2 * (used_ + points_.size()) + 2));
    for (std::size_t i = 0; i < points_.size(); ++i) {
        if ((i & 0xfffff) == 0) check_interrupt();
        add(static_cast<std::int32_t>(i));
    }
}

std::int32_t PointTable::find(const glm::dvec3& place) const {
    if (slots_.empty() || has_nan(place)) return -1;
    const std::int32_t entry = slots_[slot_of(place)];
    return entry > 0 ? entry - 1 : -1;
}

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

// Adds those points of a piece that the mesh lacks. Returns each point's index in the mesh.
std::vector<std::int32_t> MeshAssembly::add_points(const MeshPiece& piece) {
    std::vector<std::int32_t> indices(piece.points.size(), -1);
    if (!mesh_.points.empty()) {
        if (!table_) table_.emplace(mesh_.points).add_all();
        PointTable own(piece.points);
        own.add_all();
        for (std::size_t i = 0; i < indices.size(); ++i) {
            if ((i & 0xfffff) == 0) check_interrupt();
            if (own.find(piece.points[i]) >= 0) indices[i] = table_->find(piece.points[i]);
        }
    }
    const auto merged = static_cast<std::size_t>(
        std::ranges::count_if(indices, [](std::int32_t index) { return index >= 0; }));
    const std::size_t total = mesh_.points.size() + piece.points.size() - merged;
    if (total > most_points)
        fail("{}: found {} points, expected at most {}", piece.label, total, most_points);
    mesh_.cells.merged_points += static_cast<std::int64_t>(merged);
    if (mesh_.points.empty()) mesh_.points.reserve(total);
    for (std::size_t i = 0; i < indices.size(); ++i) {
        if (indices[i] >= 0) continue;
        indices[i] = static_cast<std::int32_t>(mesh_.points.size());
        mesh_.points.push_back(piece.points[i]);
        if (table_) table_->add(indices[i]);
    }
    return indices;
}

// Adds the tets of a piece's cells. Returns the number of the cell from which each tet was cut.
std::vector<std::int64_t> MeshAssembly::add_cells(const MeshPiece& piece,
                                                  const std::vector<bool>& ghosts,
                                                  std::span<const std::int32_t> indices) {
    std::vector<std::int64_t> cell_of_tet;
    cell_of_tet.reserve(piece.cells.types.size());
    // Reserves for the first piece only: with many small ones, each would reallocate the vector.
    if (mesh_.tets.empty()) mesh_.tets.reserve(piece.cells.types.size());
    std::array<std::int32_t, most_cell_points> corners{};
    for (std::size_t cell = 0; cell < piece.cells.types.size(); ++cell) {
        if ((cell & 0xfffff) == 0) check_interrupt();
        const std::int64_t type = piece.cells.types[cell];
        const CellUse use = use_of_cell(type);
        if (use == CellUse::skip || ghosts[cell]) {
            ++(ghosts[cell] ? mesh_.cells.ghosts : mesh_.cells.skipped);
            continue;
        }
        if (use == CellUse::unsupported) {
            fail(
                "{}: cell {} (the first is 0): found VTK cell type {}, expected tetrahedra (10), "
                "hexahedra (12), voxels (11), wedges (13), pyramids (14), their quadratic kinds "
                "(24 to 27, 29, 31 to 33, 37) or cells without volume",
                piece.label, cell, type);
        }
        const auto used = corners_of(piece, cell, indices, corners);
        SplitCell split{{{{used[0], used[1], used[2], used[3]}}}, 1};
        if (use == CellUse::split) {
            split = split_cell(find_type(type)->straight, used, mesh_.points);
            ++mesh_.cells.split;
        }
        mesh_.cells.straightened += find_type(type)->straight != type;
        mesh_.tets.insert(mesh_.tets.end(), split.tets.begin(),
                          split.tets.begin() + static_cast<std::ptrdiff_t>(split.count));
        cell_of_tet.insert(cell_of_tet.end(), split.count, static_cast<std::int64_t>(cell));
    }
    return cell_of_tet;
}

// Adds the scalars of a piece's points. A point that an earlier piece also has keeps its value; a
// warning counts the points for which this piece has another value.
void MeshAssembly::add_point_scalars(MeshPiece& piece, std::size_t points_before,
                                     std::span<const std::int32_t> indices) {
    if (first_) {
        mesh_.point_scalars = std::move(piece.point_scalars);
        return;
    }
    const auto more = matched(mesh_.point_scalars, piece.point_scalars, piece, "point data");
    for (std::size_t number = 0; number < more.size(); ++number) {
        std::vector<double>& values = mesh_.point_scalars[number].values;
        std::size_t different = 0;
        for (std::size_t i = 0; i < indices.size(); ++i) {
            const auto index = static_cast<std::size_t>(indices[i]);
            const double value = more[number]->values[i];
            if (index >= points_before) {
                values.push_back(value);
            } else {
                different += !same(value, values[index]);
            }
        }
        if (different == 0) continue;
        warn(
            fmt::format("{}: '{}': found {} points with other values than the pieces before have "
                        "there, expected the same: theirs are used",
                        piece.label, one_line(more[number]->name), different));
    }
}

void MeshAssembly::add(MeshPiece piece) {
    if (piece.points.empty() && piece.cells.types.empty()) return;
    check_ends(piece);
    take_ghosts(piece.point_scalars, 0);
    const std::vector<bool> ghosts = take_ghosts(piece.cell_scalars, piece.cells.types.size());
    const std::size_t points_before = mesh_.points.size();
    const std::vector<std::int32_t> indices = add_points(piece);
    const std::vector<std::int64_t> cell_of_tet = add_cells(piece, ghosts, indices);
    for (MeshScalar& scalar : piece.cell_scalars) {
        std::vector<double> of_tets(cell_of_tet.size());
        for (std::size_t tet = 0; tet < of_tets.size(); ++tet) {
            of_tets[tet] = scalar.values[static_cast<std::size_t>(cell_of_tet[tet])];
        }
        scalar.values = std::move(of_tets);
    }
    add_point_scalars(piece, points_before, indices);
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
    return std::move(mesh_);
}

}  // namespace lamina
