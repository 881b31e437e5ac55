// SPDX-License-Identifier: Apache-2.0
#include "mesh_files/cell_cuts.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>
#include <iterator>
#include <set>

#include "base/error.h"

namespace lamina {
namespace {

using Shape = CellLattice::Shape;

constexpr const char* no_faces =
    "it lists no faces; write polyhedra (42), or tets by vtkDelaunay3D";
constexpr const char* tessellate = "tessellate it (vtkTessellatorFilter)";
constexpr const char* no_order = "VTK gives its points no order; write Lagrange cells (71 to 74)";
constexpr const char* no_points =
    "not all its points are points of the field; make it Lagrange cells (71 to 74) or tessellate "
    "it (vtkTessellatorFilter)";

// vtkCellType.h. Quadratic cells lack the last points of their lattice, which are made.
constexpr CellType types[] = {
    {vtk_tetra, "tetrahedron", CellUse::straight, 4},
    {vtk_voxel, "voxel", CellUse::straight, 8},
    {vtk_hexahedron, "hexahedron", CellUse::straight, 8},
    {vtk_wedge, "wedge", CellUse::straight, 6},
    {vtk_pyramid, "pyramid", CellUse::straight, 5},
    {15, "pentagonal prism", CellUse::faces, 10},
    {16, "hexagonal prism", CellUse::faces, 12},
    {24, "quadratic tetrahedron", CellUse::lattice, 10, {Shape::tet}},
    {25, "quadratic hexahedron", CellUse::lattice, 20, {Shape::hexahedron}},
    {26, "quadratic wedge", CellUse::lattice, 15, {Shape::wedge}},
    {27, "quadratic pyramid", CellUse::lattice, 13, {Shape::pyramid}},
    {29, "triquadratic hexahedron", CellUse::lattice, 27, {Shape::hexahedron}},
    {31, "quadratic linear wedge", CellUse::lattice, 12, {Shape::wedge, {2, 2, 1}}},
    {32, "biquadratic quadratic wedge", CellUse::lattice, 18, {Shape::wedge}},
    {33, "biquadratic quadratic hexahedron", CellUse::lattice, 24, {Shape::hexahedron}},
    {37, "triquadratic pyramid", CellUse::lattice, 19, {Shape::starred}},
    {42, "polyhedron", CellUse::faces, 0},
    {71, "Lagrange tetrahedron", CellUse::lattice, 0, {Shape::tet}},
    {72, "Lagrange hexahedron", CellUse::lattice, 0, {Shape::hexahedron}},
    {73, "Lagrange wedge", CellUse::lattice, 0, {Shape::wedge}},
    {74, "Lagrange pyramid", CellUse::lattice, 0, {Shape::pyramid}},
    {41, "convex point set", CellUse::refused, 0, {}, no_faces},
    {55, "parametric tetrahedron", CellUse::refused, 0, {}, tessellate},
    {56, "parametric hexahedron", CellUse::refused, 0, {}, tessellate},
    {64, "higher-order tetrahedron", CellUse::refused, 0, {}, no_order},
    {65, "higher-order wedge", CellUse::refused, 0, {}, no_order},
    {66, "higher-order pyramid", CellUse::refused, 0, {}, no_order},
    {67, "higher-order hexahedron", CellUse::refused, 0, {}, no_order},
    {78, "Bezier tetrahedron", CellUse::refused, 0, {}, no_points},
    {79, "Bezier hexahedron", CellUse::refused, 0, {}, no_points},
    {80, "Bezier wedge", CellUse::refused, 0, {}, no_points},
    {81, "Bezier pyramid", CellUse::refused, 0, {}, no_points},
};

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
    if (type == vtk_wedge) return wedge_faces;
    if (type == vtk_pyramid) return pyramid_faces;
    return hexahedron_faces;
}

// Joins the cell's point of least rank to the triangles of the faces without it (split_cell()).
SplitCell join_least_point(std::span<const Face> faces, std::span<const std::int32_t> corners,
                           std::span<const std::int32_t> ranks) {
    const auto index = [&](std::size_t corner) { return corners[corner]; };
    const auto apex =
        static_cast<std::size_t>(std::min_element(ranks.begin(), ranks.end()) - ranks.begin());
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
            if (ranks[face[i]] < ranks[face[least]]) least = i;
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

// Cuts a cell with straight edges, however it is turned (split_cell()). `places`: may be null.
SplitCell cut_straight(std::int64_t type, std::span<const std::int32_t> corners,
                       const PointPlaces* places) {
    std::array<std::int32_t, 8> order{}, ranks{};
    std::copy(corners.begin(), corners.end(), order.begin());
    if (type == vtk_tetra) return {{{{order[0], order[1], order[2], order[3]}}}, 1};
    if (type == vtk_voxel) {  // its corners lie in the order of the axes
        std::swap(order[2], order[3]);
        std::swap(order[6], order[7]);
    }
    for (std::size_t i = 0; i < corners.size(); ++i)
        ranks[i] = places == nullptr ? order[i] : places->of(order[i]);
    return join_least_point(faces_of(type), std::span(order).first(corners.size()),
                            std::span(ranks).first(corners.size()));
}

// The eight points of a quadrilateral face of a quadratic cell, corners and middles of edges, and
// the point in its middle; all numbers of the cell's points.
struct FaceMiddle {
    Shape shape;
    std::size_t number;
    std::array<std::uint8_t, 8> face;
};
constexpr FaceMiddle face_middles[] = {
    {Shape::hexahedron, 20, {0, 3, 7, 4, 11, 19, 15, 16}},
    {Shape::hexahedron, 21, {1, 2, 6, 5, 9, 18, 13, 17}},
    {Shape::hexahedron, 22, {0, 1, 5, 4, 8, 17, 12, 16}},
    {Shape::hexahedron, 23, {3, 2, 6, 7, 10, 18, 14, 19}},
    {Shape::hexahedron, 24, {0, 1, 2, 3, 8, 9, 10, 11}},
    {Shape::hexahedron, 25, {4, 5, 6, 7, 12, 13, 14, 15}},
    {Shape::wedge, 15, {0, 1, 4, 3, 6, 13, 9, 12}},
    {Shape::wedge, 16, {1, 2, 5, 4, 7, 14, 10, 13}},
    {Shape::wedge, 17, {2, 0, 3, 5, 8, 12, 11, 14}},
    {Shape::pyramid, 13, {0, 1, 2, 3, 5, 6, 7, 8}},
};

// A tet counts as turned over if its volume has the other sign than its cell's and more than this
// share of it, far above rounding.
constexpr double rounded_share = 1e-12;

bool repeats_corner(const Tet& tet) {
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (tet[i] == tet[j]) return true;
    return false;
}

}  // namespace

const CellType* find_cell_type(std::int64_t number) {
    const auto* const found = std::ranges::find(types, number, &CellType::number);
    return found == std::end(types) ? nullptr : found;
}

bool has_no_volume(std::int64_t type) {
    constexpr std::int64_t without[] = {0,  1,  2,  3,  4,  5,  6,  7,  8,  9,  21,
                                        22, 23, 28, 30, 34, 35, 36, 51, 52, 53, 54,
                                        60, 61, 62, 63, 68, 69, 70, 75, 76, 77};
    return std::ranges::count(without, type) > 0;
}

SplitCell split_cell(std::int64_t type, std::span<const std::int32_t> corners,
                     std::span<const glm::dvec3> points, const PointPlaces* places) {
    assert(corners.size() == find_cell_type(type)->points);
    SplitCell cell = cut_straight(type, corners, places);
    if (type == vtk_wedge) {
        double sum = 0;
        for (std::size_t i = 0; i < cell.count; ++i) sum += volume(cell.tets[i], points);
        for (std::size_t i = 0; sum < 0 && i < cell.count; ++i) {
            std::swap(cell.tets[i][2], cell.tets[i][3]);
        }
    }
    return cell;
}

PolyhedronFaces faces_of_prism(std::span<const std::int32_t> points) {
    const std::size_t sides = points.size() / 2;
    PolyhedronFaces faces{{points.begin(), points.end()}, {sides, 2 * sides}};
    for (std::size_t i = 0; i < sides; ++i) {
        const std::size_t next = (i + 1) % sides;
        faces.corners.insert(faces.corners.end(),
                             {points[i], points[next], points[sides + next], points[sides + i]});
        faces.ends.push_back(faces.corners.size());
    }
    return faces;
}

void CellCuts::add_straight(std::int64_t type, std::span<const std::int32_t> corners) {
    const SplitCell cell = split_cell(type, corners, mesh_.points, &places_);
    mesh_.tets.insert(mesh_.tets.end(), cell.tets.begin(),
                      cell.tets.begin() + static_cast<std::ptrdiff_t>(cell.count));
    mesh_.cells.split += type != vtk_tetra;
}

void CellCuts::add_lattice(const CellLattice& lattice, std::span<const std::int32_t> points) {
    constexpr std::int64_t straight[] = {vtk_tetra, vtk_hexahedron, vtk_wedge, vtk_pyramid};
    if (std::ranges::max(lattice.order) == 1) {
        add_straight(straight[static_cast<std::size_t>(lattice.shape)], points);
        return;
    }
    const std::pair key{lattice, points.size()};
    auto found = parts_.find(key);
    if (found == parts_.end())
        found = parts_.emplace(key, cut_lattice(lattice, points.size())).first;
    points_.assign(points.begin(), points.end());
    if (lattice.shape != Shape::starred) make_missing(lattice, points.size());
    const std::size_t first_tet = mesh_.tets.size();
    for (const SubCell& part : found->second) add_part(part);
    judge_curved(first_tet, lattice.shape == Shape::wedge || points.size() == 21);
    ++mesh_.cells.straightened;
    mesh_.cells.split += lattice.shape != Shape::tet;
}

// Makes those points of a quadratic cell's lattice that the file lacks.
void CellCuts::make_missing(const CellLattice& lattice, std::size_t given) {
    const std::size_t wanted = lattice.points();
    while (points_.size() < wanted) {
        const std::size_t number = points_.size();
        const auto* const middle = std::ranges::find_if(face_middles, [&](const FaceMiddle& one) {
            return one.shape == lattice.shape && one.number == number;
        });
        if (middle != std::end(face_middles)) {
            std::array<std::int32_t, 8> face{};
            for (std::size_t i = 0; i < 8; ++i) face[i] = points_[middle->face[i]];
            points_.push_back(made_.middle_of(face));
            continue;
        }
        // The middle of a hexahedron, by the shape functions of vtkQuadraticHexahedron and
        // vtkBiQuadraticQuadraticHexahedron there.
        std::vector<double> weights(given, given == 20 ? .25 : 0);
        if (given == 20) std::fill_n(weights.begin(), 8, -.25);
        if (given == 24) {
            std::fill_n(weights.begin() + 16, 4, -.25);
            std::fill_n(weights.begin() + 20, 4, .5);
        }
        points_.push_back(made_.add(std::span(points_).first(given), weights));
    }
}

void CellCuts::add_part(const SubCell& part) {
    constexpr std::size_t octahedron_corners = 6;
    const std::size_t count =
        part.type == octahedron ? octahedron_corners : find_cell_type(part.type)->points;
    std::array<std::int32_t, 8> corners{};
    for (std::size_t i = 0; i < count; ++i) corners[i] = points_[part.corners[i]];
    if (part.type == octahedron) {
        add_octahedron(corners);
        return;
    }
    const SplitCell cell = cut_straight(part.type, std::span(corners).first(count), &places_);
    mesh_.tets.insert(mesh_.tets.end(), cell.tets.begin(),
                      cell.tets.begin() + static_cast<std::ptrdiff_t>(cell.count));
}

// Cuts an octahedron into four tets around its shortest diagonal.
void CellCuts::add_octahedron(const std::array<std::int32_t, 8>& corners) {
    // Each diagonal, then the other corners around it.
    constexpr std::size_t diagonals[3][6] = {
        {5, 0, 1, 3, 4, 2}, {4, 1, 0, 2, 5, 3}, {3, 2, 0, 4, 5, 1}};
    const auto length = [&](const std::size_t(&diagonal)[6]) {
        return glm::distance(mesh_.points[static_cast<std::size_t>(corners[diagonal[0]])],
                             mesh_.points[static_cast<std::size_t>(corners[diagonal[1]])]);
    };
    const auto& around = *std::ranges::min_element(diagonals, {}, length);
    for (std::size_t i = 0; i < 4; ++i) {
        mesh_.tets.push_back({corners[around[0]], corners[around[1]], corners[around[2 + i]],
                              corners[around[2 + (i + 1) % 4]]});
    }
}

// Counts the tets of a cell of higher order that its curved edges turn over. `either_sense`: the
// cell may be numbered in either sense, so if its volume is negative, all tets are turned.
void CellCuts::judge_curved(std::size_t first_tet, bool either_sense) {
    const std::span<Tet> tets = std::span(mesh_.tets).subspan(first_tet);
    double sum = 0;
    for (const Tet& tet : tets) sum += volume(tet, mesh_.points);
    const double sign = sum < 0 ? -1 : 1;
    for (Tet& tet : tets) {
        if (!repeats_corner(tet) &&
            sign * volume(tet, mesh_.points) < -rounded_share * std::abs(sum))
            ++mesh_.cells.turned_over;
        if (either_sense && sum < 0) std::swap(tet[2], tet[3]);
    }
}

void CellCuts::add_polyhedron(const PolyhedronFaces& faces) {
    const std::set<std::int32_t> all(faces.corners.begin(), faces.corners.end());
    points_.assign(all.begin(), all.end());
    const std::int32_t inside = made_.add(
        points_, std::vector<double>(points_.size(), 1 / static_cast<double>(points_.size())));
    const std::size_t first_tet = mesh_.tets.size();
    const auto place = [&](std::int32_t point) { return places_.of(point); };
    // Edges of the faces, by place. Faces are turned so that the inside lies behind them.
    std::vector<std::pair<std::int32_t, std::int32_t>> edges;
    double whole = 0, least = 0;
    for (std::size_t i = 0, begin = 0; i < faces.ends.size(); begin = faces.ends[i++]) {
        std::vector<std::int32_t> face(
            faces.corners.begin() + static_cast<std::ptrdiff_t>(begin),
            faces.corners.begin() + static_cast<std::ptrdiff_t>(faces.ends[i]));
        std::rotate(face.begin(), std::ranges::min_element(face, {}, place), face.end());
        const auto is_same = [&](std::int32_t a, std::int32_t b) { return place(a) == place(b); };
        face.erase(std::unique(face.begin(), face.end(), is_same), face.end());
        if (face.size() > 1 && place(face.back()) == place(face.front())) face.pop_back();
        if (face.size() < 3) continue;
        double sum = 0, turned = 0, most = 0;
        const std::size_t face_tet = mesh_.tets.size();
        for (std::size_t k = 2; k < face.size(); ++k) {
            const Tet& tet = mesh_.tets.emplace_back(Tet{inside, face[0], face[k - 1], face[k]});
            const double v = volume(tet, mesh_.points);
            sum += v;
            turned = std::min(turned, v);
            most = std::max(most, v);
        }
        if (sum < 0) {
            for (Tet& tet : std::span(mesh_.tets).subspan(face_tet)) std::swap(tet[2], tet[3]);
            std::reverse(face.begin(), face.end());
            turned = -most;
        }
        whole += std::abs(sum);
        least = std::min(least, turned);
        for (std::size_t k = 0; k < face.size(); ++k)
            edges.emplace_back(place(face[k]), place(face[(k + 1) % face.size()]));
    }
    // It is star-shaped if no triangle is turned over and each edge has a face on either side.
    std::ranges::sort(edges);
    bool closed = std::ranges::adjacent_find(edges) == edges.end();
    for (const auto& [a, b] : edges)
        closed = closed && std::ranges::binary_search(edges, std::pair(b, a));
    mesh_.cells.not_star_shaped += !closed || least < -rounded_share * whole;
    mesh_.cells.split += mesh_.tets.size() > first_tet;
}

std::int32_t MadePoints::add(std::span<const std::int32_t> sources,
                             std::span<const double> weights) {
    if (mesh_.points.size() >= most_points)
        fail("cells need more points than the {} that a mesh may have", most_points);
    glm::dvec3 place(0);
    for (std::size_t i = 0; i < sources.size(); ++i)
        place += weights[i] * mesh_.points[static_cast<std::size_t>(sources[i])];
    mesh_.points.push_back(place);
    if (places_.known()) places_.look();
    sources_.insert(sources_.end(), sources.begin(), sources.end());
    weights_.insert(weights_.end(), weights.begin(), weights.end());
    ends_.push_back(sources_.size());
    ++mesh_.cells.made_points;
    return static_cast<std::int32_t>(mesh_.points.size() - 1);
}

std::int32_t MadePoints::middle_of(const std::array<std::int32_t, 8>& face) {
    constexpr std::array<double, 8> weights{-.25, -.25, -.25, -.25, .5, .5, .5, .5};
    auto key = face;
    const auto rank = [&](std::int32_t point) { return std::pair(places_.of(point), point); };
    std::ranges::sort(std::span(key).first(4), {}, rank);
    std::ranges::sort(std::span(key).last(4), {}, rank);
    const auto [found, is_new] = middles_.try_emplace(key, 0);
    if (is_new) found->second = add(key, weights);
    return found->second;
}

void MadePoints::append_values() {
    for (MeshScalar& scalar : mesh_.point_scalars) {
        std::size_t at = 0;
        for (const std::size_t end : ends_) {
            double value = 0;
            for (; at < end; ++at)
                value += weights_[at] * scalar.values[static_cast<std::size_t>(sources_[at])];
            scalar.values.push_back(value);
        }
    }
    sources_.clear();
    weights_.clear();
    ends_.clear();
}

}  // namespace lamina
