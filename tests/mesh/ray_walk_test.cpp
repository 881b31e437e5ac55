// SPDX-License-Identifier: Apache-2.0
#include "mesh/ray_walk.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/glm.hpp>
#include <random>

#include "support/split_box.h"

namespace lamina {
namespace {

double slope(const glm::dvec3& p) {
    return 3 * p.x - 2 * p.y + p.z;
}

// Expects for a line through a mesh without overlaps that segments join, and that each crossing
// lies on the line and on the face.
void expect_walk_right(const TetMesh& mesh, const RayWalk& walk, const glm::dvec3& origin,
                       const glm::dvec3& direction, double tolerance) {
    ASSERT_FALSE(walk.overlapping());
    for (const RayWalk::Entry& entry : walk.entries()) {
        double last = entry.at;
        walk.follow(entry, [&](const TetSegment& segment) {
            EXPECT_EQ(segment.in.at, last);
            last = segment.out.at;
            glm::dvec3 place(0);
            for (std::size_t i = 0; i < 3; ++i) {
                EXPECT_GE(segment.out.weights[i], 0);
                place += segment.out.weights[i] *
                         mesh.points()[static_cast<std::size_t>(segment.out.corners[i])];
            }
            EXPECT_LT(glm::length(place - (origin + segment.out.at * direction)), tolerance);
            return !testing::Test::HasFailure();
        });
    }
}

// Lines pass meshes with very bad tets. Places seen from 7 units (in the 1-norm) have errors of 8
// epsilon * 7 = 1.2e-14. A crossing that rounding puts on the wrong side of a short edge of a
// needle is moved onto the edge by a multiple of that, which grows as the needle gets thinner:
// 1.3e-13 was measured at 1e-6, 1.1e-12 at 1e-9.
TEST(RayWalk, PassesSliversAndNeedles) {
    for (const double least : {.1, 1e-3, 1e-6, 1e-9}) {
        const TetMesh mesh(test::split_box(7, 3000, least, slope), "splits");
        const FaceTree tree(mesh, mesh.open_faces());
        RayWalk walk(mesh, tree);
        std::mt19937 random(11);
        std::uniform_real_distribution<double> uniform(0, 1);
        std::int64_t passed = 0;
        for (int i = 0; i < 2000; ++i) {
            const glm::dvec3 origin(uniform(random) * 4 - 2, uniform(random) * 4 - 2, -2);
            // Half of the lines go through points of the mesh, where the needles are.
            glm::dvec3 aim(uniform(random), uniform(random), uniform(random));
            if (i % 2 == 0) aim = mesh.points()[random() % mesh.points().size()];
            const glm::dvec3 direction = aim - origin;
            walk.aim(origin, direction);
            ASSERT_LE(walk.entries().size(), 1u);
            expect_walk_right(mesh, walk, origin, direction, least < 1e-6 ? 1e-11 : 1e-12);
            for (const auto& entry : walk.entries())
                walk.follow(entry, [&](const TetSegment&) { return ++passed; });
            ASSERT_FALSE(HasFailure()) << "line " << i << ", least " << least;
        }
        EXPECT_GT(passed, 10000);
    }
}

// Lines and points are whole-numbered: every step is a tie that only the infinitesimal displacement
// decides.
TEST(RayWalk, PassesEdgesPointsAndFacePlanes) {
    const TetMesh mesh(test::kuhn_box({4, 4, 4}, slope), "box");
    const FaceTree tree(mesh, mesh.open_faces());
    RayWalk walk(mesh, tree);
    const std::vector<glm::dvec3> directions{{1, 0, 0},  {0, 1, 0},  {0, 0, 1}, {1, 1, 0},
                                             {0, 1, 1},  {1, 0, 1},  {1, 1, 1}, {-1, 1, 0},
                                             {1, -1, 1}, {-1, 0, 2}, {2, 1, 0}, {-1, -1, -1}};
    int inside = 0;
    for (const glm::dvec3& direction : directions) {
        for (int x = 0; x <= 4; ++x)
            for (int y = 0; y <= 4; ++y)
                for (int z = 0; z <= 4; ++z) {
                    const glm::dvec3 through(x, y, z);
                    const glm::dvec3 origin = through - 8.0 * direction;
                    walk.aim(origin, direction);
                    expect_walk_right(mesh, walk, origin, direction, 1e-13);
                    const bool inner = x > 0 && x < 4 && y > 0 && y < 4 && z > 0 && z < 4;
                    inside += inner;
                    if (inner) {
                        ASSERT_EQ(walk.entries().size(), 1u);
                    } else {  // in a face of the box, or touching it: passes inside once, or
                              // outside
                        ASSERT_LE(walk.entries().size(), 1u);
                    }
                    ASSERT_FALSE(HasFailure());
                }
    }
    EXPECT_EQ(inside, 12 * 27);
}

TEST(RayWalk, ReentersSeparatePartsAndDetectsOverlaps) {
    MeshData two = test::kuhn_box({1, 1, 1}, slope);
    const auto count = static_cast<std::int32_t>(two.points.size());
    const auto add = [&](double shift) {
        const MeshData one = test::kuhn_box({1, 1, 1}, slope);
        for (const glm::dvec3& p : one.points) two.points.push_back(p + glm::dvec3(0, 0, shift));
        for (const Tet& tet : one.tets)
            two.tets.push_back({tet[0] + count, tet[1] + count, tet[2] + count, tet[3] + count});
    };
    add(3);
    const TetMesh apart(two, "apart");
    const FaceTree tree(apart, apart.open_faces());
    RayWalk walk(apart, tree);
    walk.aim({.3, .4, -5}, {0, 0, 1});
    ASSERT_EQ(walk.entries().size(), 2u);
    EXPECT_FALSE(walk.overlapping());
    EXPECT_DOUBLE_EQ(walk.entries()[1].at, 8);

    two = test::kuhn_box({1, 1, 1}, slope);
    add(.25);
    const TetMesh over(two, "over");
    const FaceTree over_tree(over, over.open_faces());
    RayWalk over_walk(over, over_tree);
    over_walk.aim({.3, .4, -5}, {0, 0, 1});
    EXPECT_TRUE(over_walk.overlapping());
    std::vector<TetSegment> segments;
    over_walk.list(segments);
    double length = 0;
    for (const TetSegment& segment : segments) length += segment.out.at - segment.in.at;
    EXPECT_NEAR(length, 2, 1e-14);
}

}  // namespace
}  // namespace lamina
