// SPDX-License-Identifier: Apache-2.0
// Makes tetrahedral meshes of boxes for tests: regular ones, and irregular ones with thin tets.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <glm/vec3.hpp>
#include <random>

#include "lamina/mesh.h"
#include "mesh/predicates.h"

namespace lamina::test {

// Returns the mesh of cells[0] x cells[1] x cells[2] unit cubes, each cut into six tets around its
// main diagonal (Kuhn), with the scalar field(point).
template <typename Field>
MeshData kuhn_box(const std::array<std::int32_t, 3>& cells, const Field& field) {
    MeshData mesh;
    MeshScalar scalar{"s", {}};
    for (std::int32_t k = 0; k <= cells[2]; ++k)
        for (std::int32_t j = 0; j <= cells[1]; ++j)
            for (std::int32_t i = 0; i <= cells[0]; ++i) {
                mesh.points.emplace_back(i, j, k);
                scalar.values.push_back(field(mesh.points.back()));
            }
    mesh.point_scalars.push_back(scalar);
    const std::array<std::int32_t, 3> stride{1, cells[0] + 1, (cells[0] + 1) * (cells[1] + 1)};
    constexpr int axes[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
    for (std::int32_t k = 0; k < cells[2]; ++k)
        for (std::int32_t j = 0; j < cells[1]; ++j)
            for (std::int32_t i = 0; i < cells[0]; ++i)
                for (int way = 0; way < 6; ++way) {
                    Tet tet{i * stride[0] + j * stride[1] + k * stride[2], 0, 0, 0};
                    for (std::size_t step = 0; step < 3; ++step)
                        tet[step + 1] =
                            tet[step] + stride[static_cast<std::size_t>(axes[way][step])];
                    if (way >= 3) std::swap(tet[2], tet[3]);  // odd permutations are mirrored
                    mesh.tets.push_back(tet);
                }
    return mesh;
}

// Returns the unit cube, split `splits` times: a random tet is split into four at a point inside
// it. Barycentric weights of the point, before they are normalised, go down to `least`, so the
// point may lie near a corner, an edge or a face. This makes needles, slivers and edge-length
// ratios of 1 / least and more.
template <typename Field>
MeshData split_box(std::uint32_t seed, int splits, double least, const Field& field) {
    MeshData mesh = kuhn_box({1, 1, 1}, field);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (int split = 0; split < splits; ++split) {
        const auto chosen =
            static_cast<std::size_t>(uniform(random) * static_cast<double>(mesh.tets.size()));
        const Tet tet = mesh.tets[chosen];
        glm::dvec3 place(0);
        double sum = 0;
        for (const std::int32_t corner : tet) {
            const double weight = std::pow(least, uniform(random));
            sum += weight;
            place += weight * mesh.points[static_cast<std::size_t>(corner)];
        }
        place /= sum;
        std::array<Tet, 4> parts{tet, tet, tet, tet};
        const auto point = static_cast<std::int32_t>(mesh.points.size());
        mesh.points.push_back(place);
        bool inside = true;  // whether all four tets are positive after rounding
        for (std::size_t i = 0; i < 4; ++i) {
            parts[i][i] = point;
            const auto at = [&](std::size_t k) {
                return mesh.points[static_cast<std::size_t>(parts[i][k])];
            };
            inside = inside && orientation(at(0), at(1), at(2), at(3)) > 0;
        }
        if (!inside) {
            mesh.points.pop_back();
            continue;
        }
        mesh.point_scalars[0].values.push_back(field(place));
        mesh.tets[chosen] = parts[0];
        mesh.tets.insert(mesh.tets.end(), parts.begin() + 1, parts.end());
    }
    return mesh;
}

}  // namespace lamina::test
