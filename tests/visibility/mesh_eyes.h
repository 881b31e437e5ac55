// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>
#include <random>
#include <vector>

#include "mesh/predicates.h"
#include "mesh/tet_mesh.h"

namespace lamina::test {

// A scalar for meshes whose order alone is tested.
inline double no_scalar(const glm::dvec3&) {
    return 0;
}

// Returns eyes around and inside a mesh, at infinity, on points of it, and exactly in planes of its
// faces.
inline std::vector<Eye> eyes(const TetMesh& mesh, int rounds) {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const glm::dvec3 center = .5 * (mesh.bounds().min + mesh.bounds().max),
                     half = .5 * (mesh.bounds().max - mesh.bounds().min);
    std::vector<Eye> all;
    for (int i = 0; i < rounds; ++i) {
        const glm::dvec3 v(uniform(random), uniform(random), uniform(random));
        const Tet& tet = mesh.tets()[random() % mesh.tets().size()];
        const auto at = [&](std::size_t k) {
            return mesh.points()[static_cast<std::size_t>(tet[k])];
        };
        all.push_back({center + 4. * half * v});
        all.push_back({center + half * v});
        all.push_back({v, true});
        all.push_back({at(0)});
        all.push_back({at(0) + (at(1) - at(0)) + (at(2) - at(0))});  // in the plane of a face
        all.push_back({at(0) + 2. * (at(1) - at(0))});               // in line with an edge
        all.push_back({at(1) - at(0), true});                        // along an edge
        all.push_back({.25 * (at(0) + at(1) + at(2) + at(3))});
    }
    return all;
}

}  // namespace lamina::test
