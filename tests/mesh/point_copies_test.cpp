// SPDX-License-Identifier: Apache-2.0
// Points at equal places (docs/meshes.md): adjacency is by place, values are by corner.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <set>

#include "mesh/mesh_shape.h"
#include "mesh/point_table.h"
#include "mesh/ray_walk.h"
#include "mesh/tet_mesh.h"
#include "mesh/tet_overlaps.h"
#include "support/carved_mesh.h"
#include "support/expect_error.h"
#include "support/point_copies.h"
#include "support/split_box.h"

namespace lamina {
namespace {

constexpr std::size_t tets_of_cube = 6;

double bent(const glm::dvec3& p) {
    return std::sin(p.x) + p.y * p.z;
}

bool beside_the_hole(const glm::dvec3& centroid) {
    return centroid.x < 1 || centroid.x > 2 || centroid.y > 2;
}

// A mesh as one cell, and the same with a cell of its own for each `cell_tets` tets.
struct Pair {
    TetMesh shared, split;
    explicit Pair(const MeshData& data, std::size_t cell_tets = tets_of_cube)
        : shared(test::with_copies(data, test::one_cell, test::no_jump), "shared"),
          split(test::with_copies(data, cell_tets, test::no_jump), "split") {}
};

TEST(PointCopies, DoNotChangeNeighborsAndFindings) {
    const MeshData box = test::kuhn_box({3, 4, 5}, bent);
    for (const MeshData& data : {box, test::carved(box, beside_the_hole)}) {
        for (const std::size_t cell_tets : {std::size_t{1}, tets_of_cube}) {
            const auto [shared, split] = Pair(data, cell_tets);
            ASSERT_GT(split.points().size(), shared.points().size());
            EXPECT_FALSE(shared.has_copies());
            EXPECT_EQ(shared.findings().copies, 0);
            EXPECT_EQ(split.findings().copies,
                      std::ssize(split.points()) - std::ssize(shared.points()));
            EXPECT_TRUE(std::ranges::equal(split.neighbors(), shared.neighbors()));
            EXPECT_EQ(split.open_faces().size(), shared.open_faces().size());
            EXPECT_EQ(split.findings().boundary_faces, shared.findings().boundary_faces);
            EXPECT_EQ(split.findings().nonmanifold_faces, 0);
            EXPECT_EQ(split.findings().folded_faces, 0);
            EXPECT_EQ(split.findings().inverted, 0);
            EXPECT_EQ(convexity(split), convexity(shared));
            EXPECT_TRUE(find_overlaps(split, 10).pairs.empty());
            EXPECT_EQ(edge_lengths(split).ratio(), edge_lengths(shared).ratio());
        }
    }
}

TEST(PointCopies, StandForTheFirstPointAtTheirPlace) {
    const TetMesh split(test::with_copies(test::kuhn_box({2, 2, 2}, bent), 1, test::no_jump), "x");
    const auto points = split.points();
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto first = std::ranges::find(points, points[i]) - points.begin();
        EXPECT_EQ(split.places()[i], first);
    }
    const Tet& tet = split.tets()[9];
    for (const std::int32_t corner : tet)
        EXPECT_EQ(split.corner_at(9, split.place(corner)), corner);
}

// The two halves of a double tet meet at x = 0. One of them has -0 there, or the next double.
TEST(PointCopies, AreAtExactlyEqualPlaces) {
    MeshData data;
    data.points = {{0, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0},
                   {0, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 0}};
    data.tets = {{0, 2, 1, 3}, {4, 5, 6, 7}};
    for (std::size_t i = 4; i < 7; ++i) data.points[i].x = -0.0;
    const TetMesh joined(data, "joined");
    EXPECT_EQ(joined.findings().copies, 3);
    EXPECT_EQ(joined.findings().boundary_faces, 6);
    data.points[5].x = std::nextafter(0.0, 1.0);
    const TetMesh apart(data, "apart");
    EXPECT_EQ(apart.findings().copies, 2);
    EXPECT_EQ(apart.findings().boundary_faces, 8);
}

// Tets that share no points: two on one side of a face, then a third on its other side, then a copy
// of the first, and one that repeats a place.
TEST(PointCopies, CountAsOnePointInAllFindings) {
    MeshData data;
    data.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {.2, .2, 2}, {.1, .1, -1}};
    data.tets = {{0, 1, 2, 3}, {0, 1, 2, 4}};
    const auto split = [&] { return test::with_copies(data, 1, test::no_jump); };
    const TetMesh folded(split(), "folded");
    EXPECT_EQ(folded.findings().folded_faces, 1);
    EXPECT_EQ(folded.findings().boundary_faces, 6);
    EXPECT_EQ(folded.open_faces().size(), 8u);
    EXPECT_EQ(find_overlaps(folded, 10).pairs, (std::vector<TetPair>{{0, 1}}));
    data.tets.push_back({0, 2, 1, 5});
    const TetMesh three(split(), "three");
    EXPECT_EQ(three.findings().nonmanifold_faces, 1);
    EXPECT_EQ(three.findings().boundary_faces, 9);
    EXPECT_EQ(three.open_faces().size(), 12u);
    data.tets.push_back({1, 2, 0, 3});
    const TetMesh doubled(split(), "doubled");
    EXPECT_EQ(doubled.findings().duplicates, 1);
    EXPECT_EQ(doubled.tets().size(), 3u);
    EXPECT_EQ(doubled.findings().nonmanifold_faces, 1);

    MeshData collapsed = split();
    collapsed.points.push_back(collapsed.points[0]);
    collapsed.tets.push_back({0, 1, 2, static_cast<std::int32_t>(collapsed.points.size() - 1)});
    const TetMesh dropped(collapsed, "dropped");
    EXPECT_EQ(dropped.findings().repeated_corners, 1);
    EXPECT_EQ(dropped.findings().degenerate, 1);
    EXPECT_EQ(dropped.tets().size(), 3u);
    collapsed.tets = {collapsed.tets.back()};
    expect_error([&] { TetMesh(collapsed, "x.vtu"); }, {"x.vtu", "all 1 tets repeat a corner"});
}

// Points are 1 apart, and copies up to 1e-9 from the first point at their place, which they take;
// for rounding, up to 1e-12 farther than that (of a distance of 5e3).
TEST(NearPlaces, TakeWhatIsNear) {
    const MeshData box = test::kuhn_box({2, 3, 4}, bent);
    for (const double offset : {0., -1e-9, 1e3, -5e3}) {
        MeshData data = test::with_copies(box, tets_of_cube, test::no_jump);
        const std::size_t first_cell = 8;
        test::RandomJump random{5e-10};
        for (std::size_t i = 0; i < data.points.size(); ++i) {
            data.points[i] += offset;
            if (i < first_cell) continue;
            for (int axis = 0; axis < 3; ++axis)
                data.points[i][axis] += random(3 * i + static_cast<std::size_t>(axis));
        }
        const TetMesh apart(data, "apart");
        EXPECT_EQ(apart.findings().copies, 0);
        std::vector<glm::dvec3> points = data.points;
        NearPlaces few(0), some(1e-12), all(2e-9);
        few.take(points);
        EXPECT_EQ(points, data.points);
        some.take(points);
        EXPECT_LT(some.moved(), 8);
        points = data.points;
        all.take(points);
        EXPECT_GT(all.moved(), 8);
        EXPECT_LE(all.farthest(), 2e-9);
        EXPECT_GT(all.farthest(), 1e-10);
        data.points = points;
        const TetMesh joined(data, "joined");
        EXPECT_EQ(joined.findings().boundary_faces, 2 * 2 * (2 * 3 + 3 * 4 + 4 * 2));
        EXPECT_EQ(std::ssize(points) - joined.findings().copies, 3 * 4 * 5);
    }
}

// A distance may be less than that of neighbouring doubles, less than the least double's root, or
// more than the whole mesh; and points need not be numbers.
TEST(NearPlaces, HaveAnyDistance) {
    std::vector<glm::dvec3> points{
        {1e18, 0, 0}, {1e18, 1e-9, 0},  {1e18, -0.0, 2e-9}, {1e18, 1e-300, 0}, {NAN, 0, 0},
        {NAN, 0, 0},  {INFINITY, 0, 0}, {1e18, 5, 5},       {-1e90, 5, 5},     {1e18, 5 + 1e-9, 5}};
    const std::vector<glm::dvec3> before = points;
    NearPlaces near(1.5e-9);
    near.take(points);
    EXPECT_EQ(near.moved(), 3);
    EXPECT_EQ(points[1], before[0]);
    EXPECT_EQ(points[2], before[2]);
    EXPECT_EQ(points[3], before[0]);
    EXPECT_EQ(points[9], before[7]);
    std::vector<glm::dvec3> tiny{{0, 0, 0}, {3e-200, 0, 0}, {1e-200, 0, 0}};
    NearPlaces nearest(1.5e-200);
    nearest.take(tiny);
    EXPECT_EQ(tiny[1].x, 3e-200);
    EXPECT_EQ(tiny[2].x, 0);
    NearPlaces everywhere(1e100);
    everywhere.take(tiny);
    EXPECT_EQ(tiny[1].x, 0);
}

// A hundred thousand points lie at one place, and each has another value.
TEST(PointCopies, MayBeMany) {
    MeshData data;
    constexpr std::int32_t tets = 100000;
    data.point_scalars = {{"s", {}}};
    for (std::int32_t i = 0; i < tets; ++i) {
        const double x = i, next = i + 1.0;
        data.points.insert(data.points.end(),
                           {{0, 0, 0}, {x, 1, 0}, {next, 1, 0}, {.5 * (x + next), 1, 1}});
        data.tets.push_back({4 * i, 4 * i + 1, 4 * i + 2, 4 * i + 3});
        data.point_scalars[0].values.insert(data.point_scalars[0].values.end(), 4, x);
    }
    const TetMesh mesh(data, "fan");
    EXPECT_EQ(mesh.findings().copies, 2 * (tets - 1));
    EXPECT_EQ(mesh.findings().boundary_faces, 4 * tets);
    EXPECT_EQ(count_jumps(mesh, data.point_scalars[0].values), 0);
    EXPECT_EQ(equal_points(mesh, data.point_scalars[0].values).back(), 4 * tets - 1);
}

TEST(PointCopies, WithEqualValuesShareTheirGradient) {
    const auto [shared, split] = Pair(test::kuhn_box({3, 3, 2}, bent));
    const auto expected = point_gradients(shared, shared.point_scalars()[0].values);
    const auto found = point_gradients(split, split.point_scalars()[0].values);
    for (std::size_t tet = 0; tet < shared.tets().size(); ++tet) {
        for (std::size_t i = 0; i < 4; ++i)
            EXPECT_EQ(found[split.tets()[tet][i]], expected[shared.tets()[tet][i]]);
    }
}

// Each copy's value is rounded for itself, by up to 4e-7. Gradients then differ by as much, of
// values up to 20, over edges of 1 (with a factor of 10 for the sums of a tet); a mean over each
// cell alone would be off by some .1. A jump of 1e-5 is one.
TEST(PointCopies, WithValuesThatDifferByRoundingShareTheirGradient) {
    auto [shared, split] = Pair(test::kuhn_box({3, 3, 2}, bent));
    const auto expected = point_gradients(shared, shared.point_scalars()[0].values);
    std::vector<double> values = split.point_scalars()[0].values;
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] *= 1 + 2e-7 * static_cast<double>(static_cast<int>(i % 5) - 2);
    const auto found = point_gradients(split, values);
    for (std::size_t tet = 0; tet < shared.tets().size(); ++tet) {
        for (std::size_t i = 0; i < 4; ++i)
            EXPECT_LT(glm::distance(found[split.tets()[tet][i]], expected[shared.tets()[tet][i]]),
                      4e-7 * 20 * 10);
    }
    EXPECT_EQ(count_jumps(split, values), 0);
    for (std::size_t i = 0; i < values.size(); i += 4) values[i] *= 1 + 1e-5;
    EXPECT_GT(count_jumps(split, values), 0);
}

// The field is linear in each cell, and jumps between cells. A mean over two cells that took their
// values for those of one point would be off by up to 10. Rounding: the values, up to 20, have
// errors of 2e-15 over edges of 1, in sums of some 10 products.
TEST(PointCopies, WithOtherValuesHaveGradientsOfTheirOwn) {
    const auto slope = [](const glm::dvec3& p) { return 3 * p.x - 2 * p.y + p.z; };
    const MeshData data = test::kuhn_box({3, 3, 3}, slope);
    const TetMesh split(test::with_copies(data, tets_of_cube, test::RandomJump{10}), "split");
    for (const glm::dvec3& gradient : point_gradients(split, split.point_scalars()[0].values))
        EXPECT_LE(glm::distance(gradient, glm::dvec3(3, -2, 1)), 1e-12);
}

// Cubes have 2 * (2 * 3 * 4 + 3 * 2 * 4 + 3 * 3 * 3) triangles between each other in a box of 3 x 3
// x 4 cubes. A cube that alone has other values jumps at the 12 triangles of its sides.
TEST(PointCopies, JumpAtFacesBetweenCells) {
    const MeshData data = test::kuhn_box({3, 3, 4}, bent);
    const auto jumps = [&](const auto& jump) {
        const TetMesh mesh(test::with_copies(data, tets_of_cube, jump), "x");
        return count_jumps(mesh, mesh.point_scalars()[0].values);
    };
    EXPECT_EQ(jumps(test::no_jump), 0);
    EXPECT_EQ(jumps(test::RandomJump{1}), 2 * (2 * 3 * 4 + 3 * 2 * 4 + 3 * 3 * 3));
    EXPECT_EQ(jumps([](std::size_t cell) { return cell == 13 ? 1. : 0.; }), 12);
    EXPECT_EQ(jumps([](std::size_t cell) { return cell == 13 ? NAN : 0.; }), 12);
    EXPECT_EQ(jumps([](std::size_t) { return NAN; }), 0);
    const TetMesh shared(data, "shared");
    EXPECT_EQ(count_jumps(shared, shared.point_scalars()[0].values), 0);
}

// Lines meet the same tets at the same depths, and both crossings of a segment have corners of the
// segment's tet.
TEST(PointCopies, AreOnePointForLines) {
    const auto [shared, split] = Pair(test::kuhn_box({3, 3, 3}, bent));
    const FaceTree of_shared(shared, shared.open_faces()), of_split(split, split.open_faces());
    RayWalk one(shared, of_shared), other(split, of_split);
    std::vector<TetSegment> expected, found;
    for (const glm::dvec3& direction :
         {glm::dvec3(1, .3, .2), {.1, 1, -.4}, {1, 1, 1}, {0, 0, 1}, {-1, 1, 0}}) {
        for (const glm::dvec3& origin : {glm::dvec3(1.5, 1.5, 1.5), {1, 1, 1}, {1.2, .7, 2.1}}) {
            one.aim(origin, direction);
            other.aim(origin, direction);
            one.list(expected);
            other.list(found);
            ASSERT_GT(found.size(), 1u);
            ASSERT_EQ(found.size(), expected.size());
            for (std::size_t i = 0; i < found.size(); ++i) {
                EXPECT_EQ(found[i].tet, expected[i].tet);
                EXPECT_EQ(found[i].in.at, expected[i].in.at);
                EXPECT_EQ(found[i].out.at, expected[i].out.at);
                EXPECT_EQ(found[i].in.weights, expected[i].in.weights);
                const Tet& tet = split.tets()[static_cast<std::size_t>(found[i].tet)];
                for (const FaceCrossing& crossing : {found[i].in, found[i].out}) {
                    const std::set<std::int32_t> corners(crossing.corners.begin(),
                                                         crossing.corners.end());
                    EXPECT_EQ(corners.size(), 3u);
                    for (const std::int32_t corner : corners)
                        EXPECT_EQ(std::ranges::count(tet, corner), 1);
                }
            }
        }
    }
}

}  // namespace
}  // namespace lamina
