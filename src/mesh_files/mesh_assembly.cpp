// SPDX-License-Identifier: Apache-2.0
#include "mesh_files/mesh_assembly.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <span>
#include <string_view>

#include "base/error.h"
#include "base/interrupt.h"
#include "mesh_files/cell_split.h"

namespace lamina {
namespace {

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

// Returns the corners of a cell as indices into the points of the whole mesh. (The other points of
// a quadratic tetrahedron are not used. An index of theirs that is out of range still means a
// damaged file.)
std::span<const std::int32_t> corners_of(const MeshPiece& piece, std::size_t cell,
                                         std::int32_t first_point,
                                         std::array<std::int32_t, 10>& corners) {
    const std::int64_t begin = cell == 0 ? 0 : piece.cells.ends[cell - 1];
    const auto found = static_cast<std::size_t>(piece.cells.ends[cell] - begin);
    const CellType type = cell_type(piece.cells.types[cell]);
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
        corners[i] = static_cast<std::int32_t>(index + first_point);
    }
    return std::span(corners).first(found);
}

void append(std::vector<MeshScalar>& all, std::vector<MeshScalar> more, bool first,
            const MeshPiece& piece, const char* kind) {
    if (first) {
        all = std::move(more);
        return;
    }
    if (more.size() != all.size()) {
        fail("{}: found {} scalars in its {}, expected {} as in the pieces before", piece.label,
             more.size(), kind, all.size());
    }
    std::multimap<std::string_view, const MeshScalar*> by_name;  // of one name: in order
    for (const MeshScalar& scalar : more) by_name.emplace(scalar.name, &scalar);
    for (MeshScalar& scalar : all) {
        const auto same = by_name.lower_bound(scalar.name);
        if (same == by_name.end() || same->first != scalar.name) {
            fail("{}: no array '{}' in its {}, which the pieces before have", piece.label,
                 one_line(scalar.name), kind);
        }
        const std::vector<double>& values = same->second->values;
        scalar.values.insert(scalar.values.end(), values.begin(), values.end());
        by_name.erase(same);
    }
}

}  // namespace

std::vector<glm::dvec3> points_from_values(const std::vector<double>& values) {
    std::vector<glm::dvec3> points(values.size() / 3);
    for (std::size_t i = 0; i < points.size(); ++i) {
        points[i] = {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
    }
    return points;
}

MeshScalar scalar_from_values(std::string name, std::int64_t components,
                              std::vector<double> values) {
    if (components == 3) {
        for (std::size_t i = 0; i < values.size() / 3; ++i) {
            values[i] = std::hypot(values[3 * i], values[3 * i + 1], values[3 * i + 2]);
        }
        values.resize(values.size() / 3);
        values.shrink_to_fit();
    }
    return {std::move(name), std::move(values)};
}

// Returns the cell of each tet that was made.
std::vector<std::int64_t> MeshAssembly::add_cells(const MeshPiece& piece,
                                                  std::int32_t first_point) {
    std::vector<std::int64_t> cell_of_tet;
    cell_of_tet.reserve(piece.cells.types.size());
    // Memory is reserved for the first piece only. Reserved for each of many small pieces, the
    // vector would grow by one piece at a time.
    if (mesh_.tets.empty()) mesh_.tets.reserve(piece.cells.types.size());
    std::array<std::int32_t, 10> corners{};
    for (std::size_t cell = 0; cell < piece.cells.types.size(); ++cell) {
        if ((cell & 0xfffff) == 0) check_interrupt();
        const std::int64_t type = piece.cells.types[cell];
        const CellUse use = use_of_cell(type);
        if (use == CellUse::skip) {
            ++mesh_.cells.skipped;
            continue;
        }
        if (use == CellUse::unsupported) {
            fail(
                "{}: cell {} (the first is 0): found VTK cell type {}, expected tetrahedra (10, "
                "24), hexahedra (12), voxels (11), wedges (13), pyramids (14) or cells without "
                "volume",
                piece.label, cell, type);
        }
        const auto used = corners_of(piece, cell, first_point, corners);
        SplitCell split{{{{used[0], used[1], used[2], used[3]}}}, 1};
        if (use == CellUse::split) {
            split = split_cell(type, used, mesh_.points);
            ++mesh_.cells.split;
        }
        mesh_.cells.straightened += use == CellUse::tet && cell_type(type).points > 4;
        mesh_.tets.insert(mesh_.tets.end(), split.tets.begin(),
                          split.tets.begin() + static_cast<std::ptrdiff_t>(split.count));
        cell_of_tet.insert(cell_of_tet.end(), split.count, static_cast<std::int64_t>(cell));
    }
    return cell_of_tet;
}

void MeshAssembly::add(MeshPiece piece) {
    if (piece.points.empty() && piece.cells.types.empty()) return;
    check_ends(piece);
    if (piece.points.size() > most_points - mesh_.points.size()) {
        fail("{}: found {} points, expected at most {}", piece.label,
             piece.points.size() + mesh_.points.size(), most_points);
    }
    const auto first_point = static_cast<std::int32_t>(mesh_.points.size());
    mesh_.points.insert(mesh_.points.end(), piece.points.begin(), piece.points.end());
    const std::vector<std::int64_t> cell_of_tet = add_cells(piece, first_point);
    for (MeshScalar& scalar : piece.cell_scalars) {
        std::vector<double> of_tets(cell_of_tet.size());
        for (std::size_t tet = 0; tet < of_tets.size(); ++tet) {
            of_tets[tet] = scalar.values[static_cast<std::size_t>(cell_of_tet[tet])];
        }
        scalar.values = std::move(of_tets);
    }
    append(mesh_.point_scalars, std::move(piece.point_scalars), first_, piece, "point data");
    append(mesh_.cell_scalars, std::move(piece.cell_scalars), first_, piece, "cell data");
    first_ = false;
}

MeshData MeshAssembly::finish() {
    if (mesh_.points.empty()) fail("{}: found no points", file_);
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
