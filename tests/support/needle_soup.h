// SPDX-License-Identifier: Apache-2.0
// Makes meshes of long thin tets at random places that do not touch. Many of them hide one another
// in cycles.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <random>
#include <vector>

#include "lamina/mesh.h"

namespace lamina::test {

using NeedleCorners = std::array<glm::dvec3, 4>;

// Tells whether some plane at right angles to the axis separates the two tets.
inline bool apart_along(const glm::dvec3& axis, const NeedleCorners& a, const NeedleCorners& b) {
    double a_low = INFINITY, a_high = -INFINITY, b_low = INFINITY, b_high = -INFINITY;
    for (std::size_t i = 0; i < 4; ++i) {
        a_low = std::min(a_low, glm::dot(axis, a[i]));
        a_high = std::max(a_high, glm::dot(axis, a[i]));
        b_low = std::min(b_low, glm::dot(axis, b[i]));
        b_high = std::max(b_high, glm::dot(axis, b[i]));
    }
    const double gap = 1e-6 * glm::length(axis);
    return a_low > b_high + gap || b_low > a_high + gap;
}

// Tells whether two tets are apart: by the separating axis theorem they are if a face normal, or
// the cross product of an edge of each, separates them.
inline bool apart(const NeedleCorners& a, const NeedleCorners& b) {
    constexpr std::array<std::array<std::size_t, 2>, 6> edges{
        {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};
    for (const auto* const tet : {&a, &b}) {
        for (std::size_t i = 0; i < 4; ++i) {
            const glm::dvec3 &p = (*tet)[i], &q = (*tet)[(i + 1) % 4], &r = (*tet)[(i + 2) % 4];
            if (apart_along(glm::cross(q - p, r - p), a, b)) return true;
        }
    }
    for (const auto& [i, j] : edges) {
        for (const auto& [k, l] : edges) {
            if (apart_along(glm::cross(a[j] - a[i], b[l] - b[k]), a, b)) return true;
        }
    }
    return false;
}

// Returns at most `count` needles, with their middles in the unit cube and random values at their
// points. They are .3 to 1 times `length` long; their ends are .6 to 2.6 times `width` wide.
inline MeshData needle_soup(int count, std::uint32_t seed, double length, double width) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(0, 1);
    std::normal_distribution<double> normal;
    const auto direction = [&] {
        const glm::dvec3 v(normal(random), normal(random), normal(random));
        return glm::normalize(v);
    };
    std::vector<NeedleCorners> needles;
    for (int tries = 0; tries < 40 * count && std::ssize(needles) < count; ++tries) {
        const glm::dvec3 middle(uniform(random), uniform(random), uniform(random));
        const glm::dvec3 along = direction(),
                         across = glm::normalize(glm::cross(along, direction())),
                         third = glm::cross(along, across);
        const double half = .5 * length * (.3 + .7 * uniform(random)),
                     thick = width * (.3 + uniform(random));
        const NeedleCorners needle{
            middle - half * along - thick * across, middle - half * along + thick * across,
            middle + half * along - thick * third, middle + half * along + thick * third};
        bool free = true;
        for (const NeedleCorners& other : needles) free = free && apart(needle, other);
        if (free) needles.push_back(needle);
    }
    MeshData mesh;
    MeshScalar scalar{"scalar", {}};
    for (const NeedleCorners& needle : needles) {
        const auto first = static_cast<std::int32_t>(mesh.points.size());
        for (const glm::dvec3& corner : needle) {
            mesh.points.push_back(corner);
            scalar.values.push_back(uniform(random));
        }
        mesh.tets.push_back({first, first + 1, first + 2, first + 3});
    }
    mesh.point_scalars.push_back(scalar);
    return mesh;
}

}  // namespace lamina::test
