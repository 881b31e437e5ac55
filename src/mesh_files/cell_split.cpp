// SPDX-License-Identifier: Apache-2.0
#include "mesh_files/cell_split.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cassert>
#include <iterator>
#include <utility>

namespace lamina {
namespace {

constexpr std::int64_t tetra = 10, voxel = 11, hexahedron = 12, wedge = 13, pyramid = 14;

struct NumberedType {
    std::int64_t number;
    CellType type;
};
// vtkCellType.h; the corners of each come first (vtkQuadraticHexahedron.h and so on).
constexpr NumberedType types[] = {
    {tetra, {"tetrahedron", 4, 4, tetra}},
    {voxel, {"voxel", 8, 8, voxel}},
    {hexahedron, {"hexahedron", 8, 8, hexahedron}},
    {wedge, {"wedge", 6, 6, wedge}},
    {pyramid, {"pyramid", 5, 5, pyramid}},
    {24, {"quadratic tetrahedron", 10, 4, tetra}},
    {25, {"quadratic hexahedron", 20, 8, hexahedron}},
    {26, {"quadratic wedge", 15, 6, wedge}},
    {27, {"quadratic pyramid", 13, 5, pyramid}},
    {29, {"triquadratic hexahedron", most_cell_points, 8, hexahedron}},
    {31, {"quadratic linear wedge", 12, 6, wedge}},
    {32, {"biquadratic quadratic wedge", 18, 6, wedge}},
    {33, {"biquadratic quadratic hexahedron", 24, 8, hexahedron}},
    {37, {"triquadratic pyramid", 19, 5, pyramid}},
};

const CellType* find_type(std::int64_t number) {
    const auto found = std::ranges::find(types, number, &NumberedType::number);
    return found == std::end(types) ? nullptr : &found->type;
}

// Corners of a face, counter-clockwise seen from outside; a triangle has 3, then `none`.
constexpr std::size_t none = 8;
using Face = std::array<std::size_t, 4>;

constexpr Face hexahedron_faces[] = {{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4},
                                     {3, 7, 6, 2}, {0, 3, 2, 1}, {4, 5, 6, 7}};
constexpr Face wedge_faces[] = {
    {0, 1, 2, none}, {3, 5, 4, none}, {0, 3, 4, 1}, {1, 4, 5, 2}, {2, 5, 3, 0}};
constexpr Face pyramid_faces[] = {
    {0, 3, 2, 1}, {0, 1, 4, none}, {1, 2, 4, none}, {2, 3, 4, none}, {3, 0, 4, none}};

std::span<const Face> faces_of(std::int64_t type) {
    if (type == wedge) return wedge_faces;
    if (type == pyramid) return pyramid_faces;
    return hexahedron_faces;
}

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
        if (face[3] == none) {
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

CellType cell_type(std::int64_t type) {
    const CellType* const found = find_type(type);
    assert(found != nullptr);
    return *found;
}

SplitCell split_cell(std::int64_t type, std::span<const std::int32_t> corners,
                     std::span<const glm::dvec3> points) {
    assert(use_of_cell(type) == CellUse::split && corners.size() == cell_type(type).points);
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

}  // namespace lamina
