// SPDX-License-Identifier: Apache-2.0
#include "mesh/ray_walk.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <random>

#include "mesh/predicates.h"
#include "support/split_box.h"

namespace lamina {
namespace {

double slope(const glm::dvec3& p) {
    return 3 * p.x - 2 * p.y + p.z;
}

constexpr double u = 0x1p-53;  // largest rounding, as a share of the result

// Bounds the distance of a crossing's place, the mean of its corners by their weights, from the
// line's point at its depth. N is the corners' largest distance from the origin (1-norm).
// Across the line, in u N:
//     sqrt(2) 16   errors of the corners' x and y, each up to RayWalk::place_error N;
//     11           weights of three positive areas: an area 4, a sum of three 6, a quotient 1.
// If an area is not positive, the crossing is the place on an edge that is nearest to the line.
// Then these, which are more than 11, are added to the errors of the corners:
//     sqrt(2) 16   the line passes so far outside the corners as they are seen;
//     25           3 + 10 for the share of an edge (3 + 5 * 2), 12 for the distances of two edges.
// Along the line, in u N:
//     8            a corner's depth: difference 1, product and two sums 3, square 3, quotient 1;
//     7            the mean: 3 roundings of differences of depths (2 N each), and the last sum.
// In both directions, in u times the 1-norms of places: weights have a sum of 1 up to 3 u, which
// counts for the origin and for the corners, and expect_walk_right() computes the mean (4) and the
// line's point (1 of N, 1 of the place).
double largest_miss(const TetMesh& mesh, const FaceCrossing& crossing, const glm::dvec3& origin) {
    double distance = 0, size = 0;
    for (const std::int32_t corner : crossing.corners) {
        const glm::dvec3& point = mesh.points()[static_cast<std::size_t>(corner)];
        distance = std::max(distance, norm1(point - origin));
        size = std::max(size, norm1(point));
    }
    const double across = 2 * std::sqrt(2) * RayWalk::place_error + 25 * u, along = (8 + 7) * u;
    return (across + along + u) * distance + u * (3 * norm1(origin) + (3 + 4 + 1) * size);
}

// Expects for a line through a mesh without overlaps that segments join, and that each crossing
// lies on the line and on the face. A depth that rounding puts in front of the last one is replaced
// by that (RayWalk::step()), so a segment without length may lie behind its crossing.
void expect_walk_right(const TetMesh& mesh, const RayWalk& walk, const glm::dvec3& origin,
                       const glm::dvec3& direction) {
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
            const glm::dvec3 miss = place - (origin + segment.out.at * direction);
            const glm::dvec3 ahead = glm::normalize(direction);
            const double most = largest_miss(mesh, segment.out, origin);
            EXPECT_LE(glm::length(glm::cross(miss, ahead)), most);
            EXPECT_LE(glm::dot(miss, ahead), most);
            if (segment.out.at > segment.in.at) {
                EXPECT_GE(glm::dot(miss, ahead), -most);
            }
            return !testing::Test::HasFailure();
        });
    }
}

// Lines pass meshes with very bad tets.
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
            expect_walk_right(mesh, walk, origin, direction);
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
                    expect_walk_right(mesh, walk, origin, direction);
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
    // Two chains of segments end at four depths, each off by up to 15 u times the distance of its
    // corners (largest_miss(); the faces are at right angles to the line). Each length, and each
    // sum up to 2, is rounded.
    const double distance = norm1({.7, .6, 6.25});
    EXPECT_NEAR(length, 2, u * (4 * 15 * distance + 2 + 2. * static_cast<double>(segments.size())));
}

}  // namespace
}  // namespace lamina
