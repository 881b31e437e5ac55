// SPDX-License-Identifier: Apache-2.0
// Meshes that are not convex, and meshes with cycles, for tests.
#pragma once

#include <array>
#include <cmath>
#include <glm/vec3.hpp>
#include <numbers>

#include "lamina/mesh.h"

namespace lamina::test {

// Returns the mesh with only those tets for which keep(centroid) is true.
template <typename Keep>
MeshData carved(MeshData mesh, const Keep& keep) {
    std::erase_if(mesh.tets, [&](const Tet& tet) {
        glm::dvec3 sum(0);
        for (const std::int32_t corner : tet) sum += mesh.points[static_cast<std::size_t>(corner)];
        return !keep(0.25 * sum);
    });
    return mesh;
}

// Returns three tets, long sticks around the z axis that do not touch. Each has its high end over
// the low end of the next, so that for an eye above or below they hide one another in a cycle. The
// low end of stick i is 2 * width[i] wide; the high ends are .04 high.
inline MeshData three_sticks(const std::array<double, 3>& width) {
    MeshData mesh;
    for (std::size_t i = 0; i < 3; ++i) {
        const double turn = 2 * std::numbers::pi / 3 * static_cast<double>(i);
        const glm::dvec3 along(std::cos(turn), std::sin(turn), 0), across(-along.y, along.x, 0);
        // A stick lies along a side of a triangle, protrudes at both ends, and rises from one end
        // to the other.
        const glm::dvec3 low = -2.0 * along + across + glm::dvec3(0, 0, -1);
        const glm::dvec3 high = 2.0 * along + across + glm::dvec3(0, 0, 1);
        const auto first = static_cast<std::int32_t>(mesh.points.size());
        const double w = width[i];
        mesh.points.push_back(low - w * across);
        mesh.points.push_back(low + w * across);
        mesh.points.push_back(high - glm::dvec3(0, 0, .02));
        mesh.points.push_back(high + glm::dvec3(0, 0, .02));
        mesh.tets.push_back({first, first + 1, first + 2, first + 3});
    }
    return mesh;
}

// Returns a triangular prism from z = 0 to z = 1 whose top is turned by `degrees`. It is cut into
// eight tets around its centre; the diagonals of its sides all go round in the same sense. For
// degrees < 0 it is convex. For degrees > 0 its sides are dented along the diagonals, and for an
// eye above or below, the six tets at the sides hide one another in a cycle across shared faces.
inline MeshData twisted_prism(double degrees) {
    MeshData mesh;
    for (int i = 0; i < 6; ++i) {
        const double turn =
            2 * std::numbers::pi / 3 * i + (i < 3 ? 0 : degrees * std::numbers::pi / 180);
        mesh.points.emplace_back(std::cos(turn), std::sin(turn), i < 3 ? 0 : 1);
    }
    mesh.points.emplace_back(0, 0, .5);
    mesh.tets = {{0, 1, 2, 6}, {3, 4, 5, 6}};
    for (std::int32_t i = 0; i < 3; ++i) {
        const std::int32_t next = (i + 1) % 3;
        mesh.tets.push_back({i, next, next + 3, 6});
        mesh.tets.push_back({i, next + 3, i + 3, 6});
    }
    return mesh;
}

}  // namespace lamina::test
