// SPDX-License-Identifier: Apache-2.0
// Checks that every mesh made from a volume must pass.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "mesh/tet_mesh.h"
#include "support/volume_of.h"

namespace lamina::test {

inline double volume_of_tet(const MeshData& mesh, const Tet& tet) {
    const auto at = [&](std::size_t i) { return mesh.points[static_cast<std::size_t>(tet[i])]; };
    return glm::dot(glm::cross(at(1) - at(0), at(2) - at(0)), at(3) - at(0)) / 6;
}

// Expects that tets are positively oriented, share complete faces, use every point and fill the
// grid's box.
inline void expect_fills_box(const MeshData& mesh, const Grid& grid) {
    double volume = 0, least = 1e300;
    for (const Tet& tet : mesh.tets) {
        volume += volume_of_tet(mesh, tet);
        least = std::min(least, volume_of_tet(mesh, tet));
    }
    EXPECT_GT(least, 0);
    const glm::dvec3 size = grid.index_max() - grid.index_min();
    const double box = size.x * glm::length(grid.step[0]) * size.y * glm::length(grid.step[1]) *
                       size.z * glm::length(grid.step[2]);
    EXPECT_NEAR(volume, box, 1e-12 * box);  // the errors of 1e5 roundings add up to some 1e-14
    const TetMesh checked(mesh, "mesh");
    const MeshFindings& findings = checked.findings();
    EXPECT_TRUE(findings.conforming());
    EXPECT_EQ(findings.degenerate, 0);
    EXPECT_EQ(findings.inverted, 0);
    EXPECT_EQ(findings.duplicates, 0);
    EXPECT_EQ(findings.folded_faces, 0);
    EXPECT_EQ(findings.unused_points, 0);
    // Open faces (without a neighbour) inside the box would be cracks.
    for (const TetFace& open : checked.open_faces()) {
        glm::dvec3 middle(0);
        for (const std::int32_t corner : corners_of_face(checked.tets()[open.tet], open.face)) {
            middle += checked.points()[corner] / 3.0;
        }
        const glm::dvec3 index = grid.to_index(middle);
        double distance = 1e300;
        for (int axis = 0; axis < 3; ++axis) {
            distance = std::min({distance, std::abs(index[axis] - grid.index_min()[axis]),
                                 std::abs(index[axis] - grid.index_max()[axis])});
        }
        ASSERT_LT(distance, 1e-9);
    }
}

// Returns the largest |trilinear - linear| at `samples` random points of each tet.
inline double sampled_error(const MeshData& mesh, const Volume& volume, int samples) {
    std::mt19937 random(7);
    std::exponential_distribution<double> weight;
    const auto& values = mesh.point_scalars.at(0).values;
    double largest = 0;
    for (const Tet& tet : mesh.tets) {
        for (int sample = 0; sample < samples; ++sample) {
            double sum = 0, linear = 0;
            glm::dvec3 place(0);
            for (const std::int32_t corner : tet) {
                // Divided by their sum, the weights are uniform in the tet.
                const double w = weight(random);
                sum += w;
                linear += w * values[static_cast<std::size_t>(corner)];
                place += w * mesh.points[static_cast<std::size_t>(corner)];
            }
            const double field = trilinear_at(volume, volume.grid().to_index(place / sum));
            largest = std::max(largest, std::abs(field - linear / sum));
        }
    }
    return largest;
}

}  // namespace lamina::test
