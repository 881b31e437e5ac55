// SPDX-License-Identifier: Apache-2.0
// Makes meshes whose cells share no points, as discontinuous Galerkin programs write them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <random>
#include <vector>

#include "lamina/mesh.h"

namespace lamina::test {

// Returns the mesh with copies of points: `cell_tets` consecutive tets are a cell, which shares no
// point with others. jump(cell) is added to the values of a cell. Points are in the order in which
// tets use them.
template <typename Jump>
MeshData with_copies(const MeshData& mesh, std::size_t cell_tets, const Jump& jump) {
    MeshData split;
    for (const MeshScalar& scalar : mesh.point_scalars)
        split.point_scalars.push_back({scalar.name, {}});
    std::map<std::int32_t, std::int32_t> copies;  // a cell's points, by their indices in `mesh`
    for (std::size_t i = 0; i < mesh.tets.size(); ++i) {
        if (i % cell_tets == 0) copies.clear();
        Tet& tet = split.tets.emplace_back(mesh.tets[i]);
        for (std::int32_t& corner : tet) {
            const auto point = static_cast<std::size_t>(corner);
            const auto [copy, is_new] =
                copies.try_emplace(corner, static_cast<std::int32_t>(split.points.size()));
            corner = copy->second;
            if (!is_new) continue;
            split.points.push_back(mesh.points[point]);
            for (std::size_t s = 0; s < mesh.point_scalars.size(); ++s)
                split.point_scalars[s].values.push_back(mesh.point_scalars[s].values[point] +
                                                        jump(i / cell_tets));
        }
    }
    return split;
}

inline constexpr std::size_t one_cell = std::numeric_limits<std::size_t>::max();
constexpr double no_jump(std::size_t) {
    return 0;
}

// Returns jumps of up to `largest`, one for each cell.
struct RandomJump {
    double largest;
    double operator()(std::size_t cell) const {
        std::mt19937 random(static_cast<std::uint32_t>(cell));
        return std::uniform_real_distribution<double>(-largest, largest)(random);
    }
};

}  // namespace lamina::test
