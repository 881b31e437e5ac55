// SPDX-License-Identifier: Apache-2.0
#include "mesh/tet_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <limits>

#include "mesh/predicates.h"
#include "support/split_box.h"

namespace lamina {
namespace {

std::vector<glm::dvec3> gradients_of(const TetMesh& mesh) {
    return point_gradients(mesh, mesh.point_scalars()[0].values);
}

// Bounds the error of the gradient at each point; infinite if the volumes around it are less than
// their roundings. A gradient is the sum of tets' d n, three products of a difference d of values
// and a normal n, over the sum of their volumes. `largest` bounds the tets' gradients, so |d| <=
// largest times an edge; `of_value` bounds the errors of values. In units of u = 2^-53, a, b and c
// being the edges from a tet's first corner:
//     2                an edge: a difference and a quotient;
//     6 sqrt(2)        a normal: products of two edges 5, their difference 1;
//     6 sqrt(2) + 4    each of three products d n: normal, d 1, product and two sums 3;
//     6 sqrt(2) + 5    a volume: normal, edge 2, product and two sums 3.
// So a tet's sum and volume have errors of 3 * 12.49 + 13.49 < 51 u largest a b c together, and of
// 2 of_value times each product of two edges. n tets at a point add n u largest to both sums; two
// quotients and the rounding of an expected number add 3.
std::vector<double> error_bounds(const TetMesh& mesh, double largest, double of_value = 0) {
    constexpr double u = 0x1p-53;  // largest rounding, as a share of the result
    struct Sums {
        double errors = 0, volumes = 0, tets = 0;
    };
    std::vector<Sums> sums(mesh.points().size());
    const std::vector<double>& values = mesh.point_scalars()[0].values;
    for (const Tet& tet : mesh.tets()) {
        const auto edge = [&](std::size_t i) {
            return mesh.points()[static_cast<std::size_t>(tet[i])] -
                   mesh.points()[static_cast<std::size_t>(tet[0])];
        };
        const double volume = glm::dot(edge(1), glm::cross(edge(2), edge(3)));
        const double a = glm::length(edge(1)), b = glm::length(edge(2)), c = glm::length(edge(3));
        const bool counts = std::ranges::all_of(tet, [&](std::int32_t point) {
            return std::isfinite(values[static_cast<std::size_t>(point)]);
        });
        if (!counts) continue;
        for (const std::int32_t point : tet) {
            Sums& at = sums[static_cast<std::size_t>(point)];
            at.errors += 2 * of_value * (a * b + b * c + c * a) + 51 * u * largest * a * b * c;
            // The volume here, and the one that is tested, are each off by 14 u a b c.
            at.volumes += volume - 28 * u * a * b * c;
            ++at.tets;
        }
    }
    std::vector<double> bounds;
    for (const Sums& at : sums)
        bounds.push_back(at.volumes > 0 ? at.errors / at.volumes + (2 * at.tets + 3) * u * largest
                                        : std::numeric_limits<double>::infinity());
    return bounds;
}

// Some points have only slivers around them.
TEST(PointGradients, MatchTheGradientOfALinearField) {
    const glm::dvec3 g(3, -.5, 7);
    // Values are at most 4 + |g|_1. Three products and two sums of up to |g|_1 are rounded, and the
    // value itself.
    const double g_norm1 = norm1(g), of_value = 0x1p-53 * (3 * g_norm1 + (4 + g_norm1));
    for (const double least : {.1, 1e-6}) {
        const TetMesh mesh(test::split_box(3, 2000, least,
                                           [&](const glm::dvec3& p) { return 4 + glm::dot(g, p); }),
                           "test");
        const std::vector<double> bounds = error_bounds(mesh, glm::length(g), of_value);
        const std::vector<glm::dvec3> found = gradients_of(mesh);
        for (std::size_t i = 0; i < found.size(); ++i)
            EXPECT_LE(glm::distance(found[i], g), bounds[i]) << least;
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
    const std::vector<double> bounds = error_bounds(mesh, 4);
    EXPECT_LE(glm::distance(found[0], {1. / 3, 0, -8. / 3}), bounds[0]);
    EXPECT_LE(glm::distance(found[3], {1, 0, 0}), bounds[3]);
    EXPECT_LE(glm::distance(found[5], {0, 0, -4}), bounds[5]);
}

TEST(PointGradients, IgnoreFlatTetsAndTetsWithoutAValue) {
    MeshData data;
    data.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {-1, 0, 0}, {9, 9, 9}};
    data.tets = {{0, 1, 2, 3}, {0, 1, 4, 2}, {0, 2, 5, 3}};  // the second lies in a plane
    data.point_scalars = {{"s", {0, 2, 0, 0, 100, NAN, 5}}};
    const TetMesh mesh(data, "test");
    const std::vector<glm::dvec3> found = gradients_of(mesh);
    const std::vector<double> bounds = error_bounds(mesh, 2);
    for (const std::size_t point : {0, 1, 2, 3})
        EXPECT_LE(glm::distance(found[point], {2, 0, 0}), bounds[point]) << point;
    for (const std::size_t point : {4, 5, 6}) EXPECT_EQ(found[point], glm::dvec3(0)) << point;
}

// Gradients scale with the size of the world. Points are 0, 1 or 2 along each axis, so scaled ones
// are exact, and both gradients have errors. The largest gradient of a tet is (2, 2, 1).
TEST(PointGradients, ScaleWithTheWorld) {
    MeshData data = test::kuhn_box({2, 2, 2}, [](const glm::dvec3& p) { return p.x * p.y + p.z; });
    const TetMesh mesh(data, "test");
    const std::vector<glm::dvec3> expected = gradients_of(mesh);
    const std::vector<double> bounds = error_bounds(mesh, 3);
    for (const double size : {1e-99, 1e95}) {
        MeshData scaled = data;
        for (glm::dvec3& point : scaled.points) point *= size;
        const std::vector<glm::dvec3> found = gradients_of(TetMesh(scaled, "test"));
        for (std::size_t i = 0; i < found.size(); ++i)
            EXPECT_LE(glm::distance(found[i] * size, expected[i]), 2 * bounds[i]) << size;
    }
}

}  // namespace
}  // namespace lamina
