// SPDX-License-Identifier: Apache-2.0
#include "mesh/tet_mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/glm.hpp>

#include "support/split_box.h"

namespace lamina {
namespace {

std::vector<glm::dvec3> gradients_of(const TetMesh& mesh) {
    return point_gradients(mesh, mesh.point_scalars()[0].values);
}

// Each tet's gradient is g, |g| = 7.6. The error: a tet's volume times its gradient is a sum of
// three products of a difference of values and a normal, a cross product of two edges. In units of
// u = 2^-53: stored values (up to 14) have errors of 45 (three products, three sums), so their
// differences have 104; a normal has 8 of the product of its edges, which a difference multiplies
// by 14 at most. That makes 216 in each direction, 375 in space, and the volume's own error 8
// sqrt(3) |g| = 106: less than 500 u for each product of two edges. Some points have only slivers
// around them.
TEST(PointGradients, MatchTheGradientOfALinearField) {
    const glm::dvec3 g(3, -.5, 7);
    for (const double least : {.1, 1e-6}) {
        const TetMesh mesh(test::split_box(3, 2000, least,
                                           [&](const glm::dvec3& p) { return 4 + glm::dot(g, p); }),
                           "test");
        std::vector<double> errors(mesh.points().size()), volumes(mesh.points().size());
        for (const Tet& tet : mesh.tets()) {
            const auto edge = [&](std::size_t i) {
                return mesh.points()[static_cast<std::size_t>(tet[i])] -
                       mesh.points()[static_cast<std::size_t>(tet[0])];
            };
            const double volume = glm::dot(edge(1), glm::cross(edge(2), edge(3)));
            const double a = glm::length(edge(1)), b = glm::length(edge(2)),
                         c = glm::length(edge(3));
            for (const std::int32_t point : tet) {
                errors[static_cast<std::size_t>(point)] += 500 * 0x1p-53 * (a * b + b * c + c * a);
                volumes[static_cast<std::size_t>(point)] += std::abs(volume);
            }
        }
        const std::vector<glm::dvec3> found = gradients_of(mesh);
        for (std::size_t i = 0; i < found.size(); ++i)
            EXPECT_LE(glm::distance(found[i], g), errors[i] / volumes[i]) << least;
    }
}

// Two tets share point 0: one of volume 1/6 with gradient (1, 0, 0), one of volume 1/3 with (0, 0,
// -4). The points of only one tet have its gradient.
TEST(PointGradients, AreMeansWeightedByVolume) {
    MeshData data;
    data.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -2}};
    data.tets = {{0, 1, 2, 3}, {0, 4, 6, 5}};
    data.point_scalars = {{"s", {0, 1, 0, 0, 0, 0, 8}}};
    const TetMesh mesh(data, "test");
    const std::vector<glm::dvec3> found = gradients_of(mesh);
    EXPECT_LE(glm::distance(found[0], {1. / 3, 0, -8. / 3}), 1e-14);
    EXPECT_LE(glm::distance(found[3], {1, 0, 0}), 1e-14);
    EXPECT_LE(glm::distance(found[5], {0, 0, -4}), 1e-14);
}

TEST(PointGradients, IgnoreFlatTetsAndTetsWithoutAValue) {
    MeshData data;
    data.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {-1, 0, 0}, {9, 9, 9}};
    data.tets = {{0, 1, 2, 3}, {0, 1, 4, 2}, {0, 2, 5, 3}};  // the second lies in a plane
    data.point_scalars = {{"s", {0, 2, 0, 0, 100, NAN, 5}}};
    const TetMesh mesh(data, "test");
    const std::vector<glm::dvec3> found = gradients_of(mesh);
    for (const std::size_t point : {0, 1, 2, 3})
        EXPECT_LE(glm::distance(found[point], {2, 0, 0}), 1e-14) << point;
    for (const std::size_t point : {4, 5, 6}) EXPECT_EQ(found[point], glm::dvec3(0)) << point;
}

// Gradients scale with the size of the world.
TEST(PointGradients, ScaleWithTheWorld) {
    MeshData data = test::kuhn_box({2, 2, 2}, [](const glm::dvec3& p) { return p.x * p.y + p.z; });
    const std::vector<glm::dvec3> expected = gradients_of(TetMesh(data, "test"));
    for (const double size : {1e-99, 1e95}) {
        MeshData scaled = data;
        for (glm::dvec3& point : scaled.points) point *= size;
        const std::vector<glm::dvec3> found = gradients_of(TetMesh(scaled, "test"));
        for (std::size_t i = 0; i < found.size(); ++i)
            EXPECT_LE(glm::distance(found[i] * size, expected[i]), 1e-13) << size;
    }
}

}  // namespace
}  // namespace lamina
