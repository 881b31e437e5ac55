// SPDX-License-Identifier: Apache-2.0
#include "mesh/tet_overlaps.h"

#include <gtest/gtest.h>

#include "support/carved_mesh.h"
#include "support/needle_soup.h"
#include "support/split_box.h"

namespace lamina {
namespace {

std::int64_t overlapping(const MeshData& mesh) {
    const TetOverlaps found = find_overlaps(TetMesh(mesh, "mesh"), 10'000);
    EXPECT_TRUE(found.complete);
    return std::ssize(tets_of(found.pairs));
}

MeshData tet_at(const glm::dvec3& place, double size) {
    MeshData mesh;
    mesh.points = {place, place + glm::dvec3(size, 0, 0), place + glm::dvec3(0, size, 0),
                   place + glm::dvec3(0, 0, size)};
    mesh.tets = {{0, 1, 2, 3}};
    return mesh;
}

MeshData both(MeshData mesh, const MeshData& other) {
    const auto first = static_cast<std::int32_t>(mesh.points.size());
    mesh.points.insert(mesh.points.end(), other.points.begin(), other.points.end());
    for (Tet tet : other.tets) {
        for (std::int32_t& corner : tet) corner += first;
        mesh.tets.push_back(tet);
    }
    return mesh;
}

TEST(MeshOverlap, IsNoneIfPartsAreApartOrTouch) {
    const auto nothing = [](const glm::dvec3&) { return 0.0; };
    EXPECT_EQ(overlapping(test::kuhn_box({3, 2, 2}, nothing)), 0);
    EXPECT_EQ(overlapping(test::three_sticks({.3, .2, .25})), 0);
    EXPECT_EQ(overlapping(test::needle_soup(60, 3, 1, .03)), 0);
    EXPECT_EQ(overlapping(both(tet_at({0, 0, 0}, 1), tet_at({1, 0, 0}, 1))), 0);  // at a point
    // Two tets that share a face, with two copies of its points.
    MeshData behind = tet_at({0, 0, 0}, 1);
    behind.points[3].z = -1;
    EXPECT_EQ(overlapping(both(tet_at({0, 0, 0}, 1), behind)), 0);
    EXPECT_EQ(overlapping(test::carved(test::kuhn_box({4, 4, 4}, nothing),
                                       [](const glm::dvec3& p) { return p.x < 2 || p.y < 2; })),
              0);
}

TEST(MeshOverlap, CountsTetsThatCutOneAnother) {
    EXPECT_EQ(overlapping(both(tet_at({0, 0, 0}, 1), tet_at({.2, .2, .2}, 1))), 2);
    EXPECT_EQ(overlapping(
                  both(both(tet_at({0, 0, 0}, 1), tet_at({.2, .2, .2}, 1)), tet_at({5, 5, 5}, 1))),
              2);
}

TEST(MeshOverlap, CountsPartsInsideOthers) {
    EXPECT_GE(overlapping(both(tet_at({0, 0, 0}, 1), tet_at({.1, .1, .1}, .1))), 1);
    EXPECT_GE(overlapping(both(tet_at({.1, .1, .1}, .1), tet_at({0, 0, 0}, 1))), 1);
}

TEST(MeshOverlap, FindsOneInnerPartAmongFiveHundred) {
    // The largest number of parts of which each is tested. No line through the outer tet meets the
    // inner one, the second part.
    MeshData mesh = both(tet_at({0, 0, 0}, 1), tet_at({.05, .05, .7}, .05));
    for (int i = 2; i < 500; ++i) mesh = both(mesh, tet_at({2.0 * i, 0, 0}, 1));
    EXPECT_GE(overlapping(mesh), 1);
}

TEST(MeshOverlap, CountsFoldedFaces) {
    MeshData folded = tet_at({0, 0, 0}, 1);
    folded.points.emplace_back(.2, .2, .5);
    folded.tets.push_back({0, 1, 2, 4});
    EXPECT_EQ(overlapping(folded), 2);
}

}  // namespace
}  // namespace lamina
