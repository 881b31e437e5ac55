// SPDX-License-Identifier: Apache-2.0
#include "mesh/flow_example.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <numbers>

namespace lamina {
namespace {

double volume_of(const MeshData& mesh, const Tet& tet) {
    const auto corner = [&](std::size_t i) {
        return mesh.points[static_cast<std::size_t>(tet[i])];
    };
    return glm::dot(glm::cross(corner(1) - corner(0), corner(2) - corner(0)),
                    corner(3) - corner(0)) /
           6;
}

TEST(FlowExample, FillsTheSpaceAroundTheCylinder) {
    const MeshData mesh = flow_mesh();
    double volume = 0;
    for (const Tet& tet : mesh.tets) {
        const double part = volume_of(mesh, tet);
        ASSERT_GT(part, 0);
        volume += part;
    }
    double top = 0, inner = 1e9;
    for (const glm::dvec3& p : mesh.points) {
        top = std::max(top, p.z);
        inner = std::min(inner, std::sqrt(p.x * p.x + p.y * p.y));
    }
    EXPECT_NEAR(inner, 0.5, 1e-12);
    // |x/a|^4 + |y/b|^4 = 1 encloses 4 a b gamma(5/4)^2 / gamma(3/2). The polygons of 80 corners
    // miss up to 1 % of it.
    const double outer = 4 * 5.8 * 2.6 * std::pow(std::tgamma(1.25), 2) / std::tgamma(1.5);
    const double expected = (outer - std::numbers::pi / 4) * top;
    EXPECT_NEAR(volume, expected, 0.01 * expected);
}

TEST(FlowExample, HasFacesThatTwoTetsShareOrLieOnTheBoundary) {
    const MeshData mesh = flow_mesh();
    std::map<std::array<std::int32_t, 3>, int> tets_of;
    for (const Tet& tet : mesh.tets)
        for (std::size_t face = 0; face < 4; ++face) {
            auto corners = corners_of_face(tet, face);
            std::sort(corners.begin(), corners.end());
            ++tets_of[corners];
        }
    std::int64_t open = 0;
    for (const auto& [corners, count] : tets_of) {
        ASSERT_LE(count, 2);
        open += count == 1;
    }
    // Two triangles for each quad: of 80 x 12 around both walls, 80 x 40 below and above.
    EXPECT_EQ(open, 2 * 2 * (80 * 12 + 80 * 40));
}

TEST(FlowExample, StandsStillAtTheCylinderAndTurnsBothWaysBehindIt) {
    const MeshData mesh = flow_mesh();
    ASSERT_EQ(mesh.point_scalars.size(), 3u);
    EXPECT_EQ(mesh.point_scalars[0].name, "vorticity");
    EXPECT_EQ(mesh.point_scalars[1].name, "pressure");
    EXPECT_EQ(mesh.point_scalars[2].name, "speed");
    double least = 0, most = 0, highest_pressure = -1;
    glm::dvec3 stagnation(0);
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
        const glm::dvec3 p = mesh.points[i];
        const double vorticity = mesh.point_scalars[0].values[i];
        if (std::sqrt(p.x * p.x + p.y * p.y) < 0.5 + 1e-9) {
            EXPECT_NEAR(mesh.point_scalars[2].values[i], 0, 1e-9);
        }
        if (p.x > 2) {
            least = std::min(least, vorticity);
            most = std::max(most, vorticity);
        }
        if (mesh.point_scalars[1].values[i] <= highest_pressure) continue;
        highest_pressure = mesh.point_scalars[1].values[i];
        stagnation = p;
    }
    EXPECT_LT(least, -1);
    EXPECT_GT(most, 1);
    EXPECT_NEAR(highest_pressure, 1, 0.01);  // Bernoulli, where the flow comes to rest
    EXPECT_NEAR(stagnation.x, -0.5, 0.01);
}

TEST(FlowExample, HasTheSameValuesEachTime) {
    const MeshData first = flow_mesh(), second = flow_mesh();
    EXPECT_EQ(first.points, second.points);
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_EQ(first.point_scalars[i].values, second.point_scalars[i].values);
}

}  // namespace
}  // namespace lamina
