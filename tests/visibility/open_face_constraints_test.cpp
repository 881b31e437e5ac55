// SPDX-License-Identifier: Apache-2.0
#include "visibility/open_face_constraints.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <utility>

#include "mesh/predicates.h"
#include "mesh_eyes.h"
#include "support/carved_mesh.h"
#include "support/delaunay_mesh.h"
#include "support/split_box.h"

namespace lamina {
namespace {

TetMesh carved_kuhn() {
    const auto no_bar = [](const glm::dvec3& c) {
        return c.x < 2 || c.x > 4 || c.y < 3 || c.y > 5;
    };
    return {test::carved(test::kuhn_box({6, 8, 5}, test::no_scalar), no_bar), "ring"};
}

TetMesh carved_delaunay(int points, unsigned share) {
    std::mt19937 random(3);
    return {test::carved(test::DelaunayMesh::make(points, 9),
                         [&](const glm::dvec3&) { return random() % share > 0; }),
            "sponge"};
}

// Returns two boxes with this gap between them; if it is 0, they touch.
TetMesh two_boxes(double gap) {
    MeshData mesh = test::kuhn_box({1, 1, 1}, test::no_scalar), other = mesh;
    const auto first = static_cast<std::int32_t>(mesh.points.size());
    for (const glm::dvec3& point : other.points)
        mesh.points.push_back(point + glm::dvec3(1 + gap, 0, 0));
    for (Tet tet : other.tets) {
        for (std::int32_t& corner : tet) corner += first;
        mesh.tets.push_back(tet);
    }
    mesh.point_scalars.clear();
    mesh.cell_scalars.clear();
    return {std::move(mesh), "boxes"};
}

// Finds gap faces by looking at all pairs: faces with a corner of another face outside of their
// plane, or with a face of opposite direction in it.
std::vector<std::int32_t> gap_faces_of_all(const TetMesh& mesh) {
    std::vector<std::int32_t> found;
    const auto open = mesh.open_faces();
    for (std::size_t i = 0; i < open.size(); ++i) {
        const Triangle t = mesh.corners(open[i]);
        const bool ends_gap = std::any_of(open.begin(), open.end(), [&](const TetFace& other) {
            const Triangle o = mesh.corners(other);
            std::array<int, 3> sides;
            for (std::size_t k = 0; k < 3; ++k) sides[k] = orientation(t[0], t[1], t[2], o[k]);
            if (std::ranges::max(sides) > 0) return true;
            const glm::dvec3 n = glm::cross(t[1] - t[0], t[2] - t[0]);
            return std::ranges::min(sides) == 0 &&
                   glm::dot(n, glm::cross(o[1] - o[0], o[2] - o[0])) < 0;
        });
        if (ends_gap) found.push_back(static_cast<std::int32_t>(i));
    }
    return found;
}

TEST(GapFaces, DoNotExistInConvexMeshes) {
    const TetMesh box(test::kuhn_box({8, 7, 6}, test::no_scalar), "kuhn");
    const TetMesh delaunay(test::DelaunayMesh::make(3000, 7), "delaunay");
    const TetMesh prism(test::twisted_prism(-20), "prism");
    const TetMesh joined = two_boxes(0);  // whose touching corners lie at equal places
    for (const TetMesh* mesh : {&box, &delaunay, &prism, &joined})
        EXPECT_TRUE(gap_faces(*mesh).empty());
}

TEST(GapFaces, AreThoseWithSomethingOutside) {
    for (const TetMesh& mesh :
         {carved_kuhn(), carved_delaunay(250, 3), carved_delaunay(600, 40),
          TetMesh(test::twisted_prism(20), "prism"), two_boxes(1e-15), two_boxes(1)}) {
        const auto expected = gap_faces_of_all(mesh);
        EXPECT_EQ(gap_faces(mesh), expected);
        EXPECT_FALSE(expected.empty());
        EXPECT_LT(expected.size(), mesh.open_faces().size());
    }
}

// One point of a flat side of 32 faces is moved by an ulp. If it moves inwards, the faces around it
// have other faces of the side outside of their planes; if outwards, the other faces have the point
// outside of theirs, too.
TEST(GapFaces, SeeADentOfAnUlp) {
    MeshData data = test::kuhn_box({4, 4, 4}, test::no_scalar);
    const auto at = static_cast<std::size_t>(std::ranges::find(data.points, glm::dvec3(2, 2, 4)) -
                                             data.points.begin());
    ASSERT_LT(at, data.points.size());
    for (const double z : {4 + 0x1p-50, 4 - 0x1p-51}) {
        data.points[at].z = z;
        const TetMesh mesh(data, "box");
        const auto found = gap_faces(mesh);
        EXPECT_EQ(found, gap_faces_of_all(mesh));
        EXPECT_EQ(found.size(), z > 4 ? 32u : 6u);
    }
}

// Compares the search, with its tree, boxes and left-out faces, with a test of all pairs of open
// faces.
TEST(OpenFaceConstraints, AreAllPairsOfFacesThatHideEachOther) {
    for (const TetMesh& mesh : {carved_kuhn(), carved_delaunay(120, 3), two_boxes(.5),
                                TetMesh(test::twisted_prism(20), "prism")}) {
        OpenFaceConstraints gaps(mesh);
        std::size_t pairs = 0;
        for (const Eye& eye : test::eyes(mesh, 3)) {
            std::vector<SeenTriangle> seen;
            for (const TetFace& face : mesh.open_faces())
                seen.emplace_back(eye, mesh.corners(face));
            std::set<std::pair<std::int32_t, std::int32_t>> expected, found;
            for (std::size_t exit = 0; exit < seen.size(); ++exit) {
                if (seen[exit].sign() <= 0) continue;
                for (std::size_t entry = 0; entry < seen.size(); ++entry) {
                    if (seen[entry].sign() < 0 &&
                        mesh.open_faces()[exit].tet != mesh.open_faces()[entry].tet &&
                        seen[exit].shows(eye, seen[entry]))
                        expected.emplace(exit, entry);
                }
            }
            for (const auto& [exit, entry] : gaps.find(eye)) found.emplace(exit, entry);
            EXPECT_EQ(found, expected) << eye.position.x << " " << eye.position.y << " "
                                       << eye.position.z << " " << eye.at_infinity;
            pairs += expected.size();
        }
        EXPECT_GT(pairs, 0u);
    }
}

}  // namespace
}  // namespace lamina
