// SPDX-License-Identifier: Apache-2.0
#include "visibility/order_graph.h"

#include <gtest/gtest.h>

#include <random>

#include "mesh_eyes.h"
#include "support/delaunay_mesh.h"
#include "support/split_box.h"

namespace lamina {
namespace {

// Expects the exact sign of each face, computed for each face alone.
void expect_exact(const TetMesh& mesh, const Eye& eye) {
    const FaceSigner signer(mesh, eye);
    for (std::size_t tet = 0; tet < mesh.tets().size(); ++tet) {
        FaceSigns expected = 0;
        for (std::size_t face = 0; face < 4; ++face) {
            const auto [a, b, c] = corners_of_face(mesh.tets()[tet], face);
            const auto at = [&](std::int32_t i) {
                return mesh.points()[static_cast<std::size_t>(i)];
            };
            const int sign = sign_as_seen(eye, at(a), at(b), at(c));
            if (sign < 0) expected |= nearer_bit(face);
            if (sign > 0) expected |= farther_bit(face);
        }
        ASSERT_EQ(signer.signs(tet), expected) << "tet " << tet;
    }
}

TEST(FaceSigns, SayFromWhichSideFacesAreSeen) {
    MeshData data;
    data.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    data.tets = {{0, 1, 2, 3}};
    const TetMesh mesh(data, "tet");
    const auto signs = [&](const Eye& eye) { return FaceSigner(mesh, eye).signs(0); };
    constexpr FaceSigns all_farther = 0xf0;
    EXPECT_EQ(signs({{.1, .1, .1}}), all_farther);  // inside
    // Beyond face 0 (x + y + z = 1), on the inner side of the three others.
    EXPECT_EQ(signs({{1, 1, 1}}), (all_farther & ~farther_bit(0)) | nearer_bit(0));
    // On the z axis beyond corner 3: faces 1 (x = 0) and 2 (y = 0) are edge-on.
    EXPECT_EQ(signs({{0, 0, 2}}), farther_bit(3) | nearer_bit(0));
    // Looking along -z from above: the same two faces are edge-on.
    EXPECT_EQ(signs({{0, 0, -3}, true}), farther_bit(3) | nearer_bit(0));
    EXPECT_EQ(signs({{0, 0, 3}, true}), farther_bit(0) | nearer_bit(3));
    // At a corner, all faces but the opposite one are edge-on.
    EXPECT_EQ(signs({{0, 0, 0}}), farther_bit(0));
}

TEST(FaceSigns, AreExactDespiteRounding) {
    const TetMesh needles(test::split_box(3, 1000, 1e-9, test::no_scalar), "needles");
    const TetMesh delaunay(test::DelaunayMesh::make(400, 5), "delaunay");
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(-1, 2);
    for (const TetMesh* mesh : {&needles, &delaunay}) {
        const auto some_point = [&] { return mesh->points()[random() % mesh->points().size()]; };
        for (int i = 0; i < 3; ++i) {
            const glm::dvec3 place(uniform(random), uniform(random), uniform(random));
            expect_exact(*mesh, {place});
            expect_exact(*mesh, {place, true});
            expect_exact(*mesh, {1e9 * place});   // everything nearly edge-on
            expect_exact(*mesh, {some_point()});  // many faces edge-on, exactly
            expect_exact(*mesh, {some_point() - some_point(), true});
        }
    }
}

}  // namespace
}  // namespace lamina
