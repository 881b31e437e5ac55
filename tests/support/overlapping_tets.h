// SPDX-License-Identifier: Apache-2.0
// Makes meshes of tets that overlap.
#pragma once

#include <glm/vec3.hpp>
#include <random>
#include <string>
#include <vector>

#include "lamina/mesh.h"
#include "support/split_box.h"

namespace lamina::test {

// Appends tets with their own points, and new values at these.
inline void append(MeshData& mesh, const std::vector<glm::dvec3>& points,
                   const std::vector<Tet>& tets) {
    const auto first = static_cast<std::int32_t>(mesh.points.size());
    if (mesh.point_scalars.empty()) mesh.point_scalars.push_back({"scalar", {}});
    for (const glm::dvec3& point : points) {
        mesh.point_scalars[0].values.push_back(static_cast<double>(mesh.points.size() * 7 % 11) /
                                               10);
        mesh.points.push_back(point);
    }
    for (const Tet& t : tets)
        mesh.tets.push_back({t[0] + first, t[1] + first, t[2] + first, t[3] + first});
}

inline void append_tet(MeshData& mesh, const std::array<glm::dvec3, 4>& corners) {
    append(mesh, {corners.begin(), corners.end()}, {{0, 1, 2, 3}});
}

// Returns a regular tet.
inline std::array<glm::dvec3, 4> regular_tet(const glm::dvec3& middle, double size) {
    return {middle + size * glm::dvec3(1, 1, 1), middle + size * glm::dvec3(-1, -1, 1),
            middle + size * glm::dvec3(-1, 1, -1), middle + size * glm::dvec3(1, -1, -1)};
}

// Returns random tets in a cube from 0 to 1, most of which overlap others if there are many.
inline MeshData tet_soup(int count, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(0, 1);
    MeshData mesh;
    for (int i = 0; i < count; ++i) {
        const glm::dvec3 middle(uniform(random), uniform(random), uniform(random));
        std::array<glm::dvec3, 4> corners;
        for (glm::dvec3& corner : corners)
            corner =
                .2 * middle + .8 * glm::dvec3(uniform(random), uniform(random), uniform(random));
        append_tet(mesh, corners);
    }
    return mesh;
}

struct OverlapCase {
    std::string name;
    MeshData mesh;
};

// Returns meshes within a cube from 0 to 1 whose tets overlap in all ways that there are.
inline std::vector<OverlapCase> overlap_cases() {
    std::vector<OverlapCase> cases;
    const auto mesh_of = [&](const std::string& name) -> MeshData& {
        return cases.emplace_back(OverlapCase{name, {}}).mesh;
    };
    MeshData& two = mesh_of("two that cut one another");
    append_tet(two, regular_tet({.45, .5, .5}, .4));
    append_tet(two, regular_tet({.6, .47, .55}, .35));
    MeshData& nested = mesh_of("three nested ones");
    for (const double size : {.2, .5, .05}) append_tet(nested, regular_tet({.5, .5, .5}, size));
    MeshData& base = mesh_of("bases in one plane");
    append_tet(base, {{{0, 0, .5}, {1, 0, .5}, {0, 1, .5}, {.2, .2, 0}}});
    append_tet(base, {{{.1, -.1, .5}, {1, .4, .5}, {.1, .8, .5}, {.3, .1, 0}}});
    append_tet(base, {{{.1, .1, .5}, {.4, .1, .5}, {.1, .4, .5}, {.2, .2, .9}}});
    MeshData& folded = mesh_of("faces of two and three tets on one side");
    append(folded, {{0, 0, .5}, {1, 0, .4}, {.3, 1, .5}, {.4, .3, 1}, {.5, .2, .9}, {.3, .4, .7}},
           {{0, 1, 2, 3}, {0, 1, 2, 4}, {0, 1, 2, 5}});
    MeshData& fan = mesh_of("tets that share an edge, or a corner");
    append(fan,
           {{0, 0, 0},
            {0, 0, 1},
            {1, .1, .3},
            {.7, .8, .6},
            {.9, .3, .4},
            {.2, 1, .6},
            {.5, .5, .1},
            {1, .4, .8},
            {.5, .3, .6}},
           {{0, 1, 2, 3}, {0, 1, 4, 5}, {0, 6, 7, 8}});
    MeshData& boxes = mesh_of("boxes of many tets, moved by less than a tet");
    for (const double shift : {0., .13}) {
        const MeshData box = kuhn_box({3, 3, 3}, [](const glm::dvec3&) { return 0.; });
        std::vector<glm::dvec3> points;
        for (const glm::dvec3& point : box.points)
            points.push_back(.25 * point + shift * glm::dvec3(1, .7, .4));
        append(boxes, points, box.tets);
    }
    MeshData& inside = mesh_of("a tet within a box, and one that leaves it");
    const MeshData box = kuhn_box({2, 2, 2}, [](const glm::dvec3&) { return 0.; });
    std::vector<glm::dvec3> points;
    for (const glm::dvec3& point : box.points) points.push_back(.5 * point);
    append(inside, points, box.tets);
    append_tet(inside, regular_tet({.4, .6, .45}, .1));
    append_tet(inside, regular_tet({.8, .3, .7}, .3));
    for (const int count : {2, 3, 5, 8, 13, 20, 50})
        cases.push_back({std::to_string(count) + " random ones",
                         tet_soup(count, static_cast<std::uint32_t>(count + 4))});
    return cases;
}

}  // namespace lamina::test
