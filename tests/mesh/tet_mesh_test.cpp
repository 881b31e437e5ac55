// SPDX-License-Identifier: Apache-2.0
#include "mesh/tet_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "mesh/predicates.h"
#include "support/expect_error.h"
#include "support/split_box.h"

namespace lamina {
namespace {

double height(const glm::dvec3& p) {
    return p.z;
}

// Compares the neighbours with those found through a map of all faces.
void expect_neighbors_right(const TetMesh& mesh) {
    std::map<std::array<std::int32_t, 3>, std::vector<std::int32_t>> tets_of;
    const auto key = [&](std::size_t tet, std::size_t face) {
        auto corners = corners_of_face(mesh.tets()[tet], face);
        std::sort(corners.begin(), corners.end());
        return corners;
    };
    for (std::size_t tet = 0; tet < mesh.tets().size(); ++tet)
        for (std::size_t face = 0; face < 4; ++face)
            tets_of[key(tet, face)].push_back(static_cast<std::int32_t>(tet));
    std::int64_t open = 0;
    for (std::size_t tet = 0; tet < mesh.tets().size(); ++tet) {
        for (std::size_t face = 0; face < 4; ++face) {
            const auto& found = tets_of[key(tet, face)];
            std::int32_t expected = TetMesh::no_neighbor;
            if (found.size() == 2)
                expected = found[0] == static_cast<std::int32_t>(tet) ? found[1] : found[0];
            ASSERT_EQ(mesh.neighbors()[tet][face], expected);
            open += expected == TetMesh::no_neighbor;
        }
    }
    EXPECT_EQ(static_cast<std::int64_t>(mesh.open_faces().size()), open);
    EXPECT_EQ(mesh.findings().boundary_faces, open);
}

void expect_positive(const TetMesh& mesh) {
    for (const Tet& tet : mesh.tets()) {
        const auto at = [&](std::size_t i) {
            return mesh.points()[static_cast<std::size_t>(tet[i])];
        };
        ASSERT_EQ(orientation(at(0), at(1), at(2), at(3)), 1);
    }
}

TEST(TetMesh, FindsNeighborsOfBoxes) {
    const TetMesh mesh(test::kuhn_box({3, 4, 5}, height), "box");
    EXPECT_EQ(mesh.tets().size(), 3u * 4 * 5 * 6);
    EXPECT_EQ(mesh.findings().boundary_faces, 2 * 2 * (3 * 4 + 4 * 5 + 5 * 3));
    EXPECT_EQ(mesh.findings().inverted, 0);
    EXPECT_EQ(mesh.findings().folded_faces, 0);
    EXPECT_EQ(mesh.findings().unused_points, 0);
    EXPECT_TRUE(mesh.findings().conforming());
    EXPECT_EQ(mesh.bounds().max, glm::dvec3(3, 4, 5));
    expect_neighbors_right(mesh);
    expect_positive(mesh);
    expect_neighbors_right(TetMesh(test::split_box(3, 2000, 1e-6, height), "splits"));
}

TEST(TetMesh, TurnsInvertedTets) {
    MeshData data = test::kuhn_box({2, 2, 2}, height);
    std::mt19937 random(5);
    std::int64_t odd = 0;
    for (Tet& tet : data.tets) {
        for (std::size_t i = 3; i > 0; --i) {  // Fisher-Yates, counting transpositions
            const std::size_t j = random() % (i + 1);
            if (i == j) continue;
            std::swap(tet[i], tet[j]);
            odd ^= 1;
        }
        data.cell_scalars.resize(1);
        data.cell_scalars[0].values.push_back(static_cast<double>(odd));
        odd = 0;
    }
    const auto& marks = data.cell_scalars[0].values;
    const auto expected = static_cast<std::int64_t>(std::count(marks.begin(), marks.end(), 1.0));
    const TetMesh mesh(data, "shuffled");
    EXPECT_EQ(mesh.findings().inverted, expected);
    EXPECT_EQ(mesh.findings().folded_faces, 0);
    expect_positive(mesh);
    expect_neighbors_right(mesh);
}

TEST(TetMesh, CountsDuplicateFlatAndRepeatedCornerTets) {
    MeshData data = test::kuhn_box({1, 1, 1}, height);
    data.cell_scalars.push_back({"c", {0, 1, 2, 3, 4, 5}});
    const auto add = [&](const Tet& tet) {
        data.tets.push_back(tet);
        data.cell_scalars[0].values.push_back(static_cast<double>(data.tets.size() - 1));
    };
    add(data.tets[2]);                                                          // 6: a duplicate,
    add({data.tets[3][1], data.tets[3][0], data.tets[3][2], data.tets[3][3]});  // 7: turned as well
    add({0, 0, 1, 2});                                                          // 8: a corner twice
    data.points.emplace_back(9, 9, NAN);                                        // used by no tet
    const TetMesh mesh(data, "bad");
    EXPECT_EQ(mesh.findings().tets_read, 9);
    EXPECT_EQ(mesh.tets().size(), 6u);
    EXPECT_EQ(mesh.findings().duplicates, 2);
    EXPECT_EQ(mesh.findings().degenerate, 1);
    EXPECT_EQ(mesh.findings().repeated_corners, 1);
    EXPECT_EQ(mesh.findings().unused_points, 1);
    EXPECT_EQ(mesh.findings().boundary_faces, 12);
    EXPECT_EQ(mesh.cell_scalars()[0].values, (std::vector<double>{0, 1, 2, 3, 4, 5}));
    EXPECT_TRUE(std::isfinite(mesh.bounds().max.z));
}

// A file may hold very many copies of a tet: these are found by sorting, not pair by pair.
TEST(TetMesh, DropsManyCopies) {
    MeshData data = test::kuhn_box({1, 1, 1}, height);
    data.tets.insert(data.tets.end(), 300000, data.tets[4]);
    const TetMesh mesh(data, "copies");
    EXPECT_EQ(mesh.tets().size(), 6u);
    EXPECT_EQ(mesh.findings().duplicates, 300000);
    EXPECT_EQ(mesh.findings().boundary_faces, 12);
}

// The mesh has two tets on one side of their common face, and three tets on one face.
TEST(TetMesh, CutsFoldedAndNonmanifoldFaces) {
    MeshData data;
    data.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {.2, .2, 2}, {.1, .1, -1}};
    data.tets = {{0, 1, 2, 3}, {0, 1, 2, 4}};
    const TetMesh folded(data, "folded");
    EXPECT_EQ(folded.findings().folded_faces, 1);
    EXPECT_EQ(folded.findings().boundary_faces, 6);
    EXPECT_EQ(folded.open_faces().size(), 8u);
    data.tets.push_back({0, 2, 1, 5});
    const TetMesh three(data, "three");
    EXPECT_EQ(three.findings().nonmanifold_faces, 1);
    EXPECT_EQ(three.findings().boundary_faces, 9);
    EXPECT_FALSE(three.findings().conforming());
    EXPECT_EQ(three.open_faces().size(), 12u);
}

// A flat tet with the corners of a square lies between two halves of a mesh that cut the square
// along different diagonals. It connects them, in whichever order its corners are listed.
TEST(TetMesh, KeepsFlatTetsAsConnections) {
    for (const bool mirrored : {false, true}) {
        MeshData data;
        data.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {.5, .5, 1}, {.5, .5, -1}};
        data.tets = {{0, 1, 2, 4}, {0, 2, 3, 4}, {0, 3, 1, 5}, {1, 3, 2, 5}, {0, 1, 2, 3}};
        if (mirrored) std::swap(data.tets[4][0], data.tets[4][1]);
        const TetMesh mesh(data, "flat");
        EXPECT_EQ(mesh.findings().degenerate, 1);
        EXPECT_EQ(mesh.findings().folded_faces, 0);
        EXPECT_EQ(mesh.findings().boundary_faces, 8);
        expect_neighbors_right(mesh);
    }
}

TEST(TetMesh, RejectsBadInput) {
    MeshData data = test::kuhn_box({1, 1, 1}, height);
    const auto build = [](const MeshData& bad) { TetMesh(bad, "x.vtu"); };
    data.tets[2][1] = 8;
    expect_error([&] { build(data); }, {"x.vtu", "tet 2", "corner 8", "0 to 7"});
    data.tets[2][1] = -1;
    expect_error([&] { build(data); }, {"tet 2", "corner -1"});
    data = test::kuhn_box({1, 1, 1}, height);
    data.points[3].y = NAN;
    expect_error([&] { build(data); }, {"point 3", "finite"});
    data.points[3].y = -2e100;
    expect_error([&] { build(data); }, {"point 3", "up to 1e100"});
    data.tets.clear();
    expect_error([&] { build(data); }, {"no tetrahedra"});
    data.tets = {{1, 1, 2, 3}};
    expect_error([&] { build(data); }, {"all 1 tets"});
}

}  // namespace
}  // namespace lamina
