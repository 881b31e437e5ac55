// SPDX-License-Identifier: Apache-2.0
#include "visibility/visibility_order.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <random>

#include "mesh/mesh_shape.h"
#include "mesh_eyes.h"
#include "support/allocation_count.h"
#include "support/carved_mesh.h"
#include "support/delaunay_mesh.h"
#include "support/expect_error.h"
#include "support/point_copies.h"
#include "support/split_box.h"
#include "visibility/order_graph.h"

namespace lamina {
namespace {

void expect_no_violation(const TetMesh& mesh, OrderMethod method, int rounds) {
    VisibilityOrder order(mesh, method);
    for (const Eye& eye : test::eyes(mesh, rounds)) {
        EXPECT_EQ(face_violations(mesh, eye, order.sort(eye)), 0)
            << eye.position.x << " " << eye.position.y << " " << eye.position.z << " "
            << eye.at_infinity;
        EXPECT_EQ(order.report().cycles, 0);
        EXPECT_EQ(order.report().broken, 0);
    }
}

TEST(VisibilityOrder, DelaunayMeshesHaveNoViolation) {
    const TetMesh mesh(test::DelaunayMesh::make(3000, 7), "delaunay");
    ASSERT_EQ(convexity(mesh), Convexity::exact);
    expect_no_violation(mesh, OrderMethod::mpvo, 12);
    expect_no_violation(mesh, OrderMethod::exact, 4);
}

TEST(VisibilityOrder, RegularMeshesHaveNoViolation) {
    const TetMesh mesh(test::kuhn_box({8, 7, 6}, test::no_scalar), "kuhn");
    expect_no_violation(mesh, OrderMethod::mpvo, 12);
    expect_no_violation(mesh, OrderMethod::exact, 4);
}

// Delaunay meshes have no cycles, nor have Kuhn meshes (which are regular triangulations), nor has
// what remains if tets are removed from one, gaps included (Edelsbrunner, An acyclicity theorem for
// cell complexes in d dimensions, 1990).
TEST(VisibilityOrder, CarvedMeshesHaveNoViolation) {
    const auto no_bar = [](const glm::dvec3& c) {
        return c.x < 2 || c.x > 4 || c.y < 3 || c.y > 5;
    };
    const TetMesh ring(test::carved(test::kuhn_box({6, 8, 5}, test::no_scalar), no_bar), "ring");
    ASSERT_FALSE(convex(ring));
    std::mt19937 random(3);
    const TetMesh sponge(test::carved(test::DelaunayMesh::make(250, 9),
                                      [&](const glm::dvec3&) { return random() % 3 > 0; }),
                         "sponge");
    for (const TetMesh* mesh : {&ring, &sponge}) {
        expect_no_violation(*mesh, OrderMethod::mpvo, 4);
        expect_no_violation(*mesh, OrderMethod::exact, 4);
    }
}

// Meshes whose tets, or cells of six tets, share no points have the order of the same mesh with
// shared points, from any eye, also in planes of faces.
TEST(VisibilityOrder, CopiesOfPointsDoNotChangeTheOrder) {
    const MeshData box = test::kuhn_box({5, 4, 6}, test::no_scalar);
    const auto no_bar = [](const glm::dvec3& c) { return c.x < 2 || c.x > 4 || c.y < 1; };
    for (const MeshData& data : {box, test::carved(box, no_bar), test::twisted_prism(8)}) {
        const TetMesh shared(test::with_copies(data, test::one_cell, test::no_jump), "shared");
        for (const std::size_t cell_tets : {1, 6}) {
            const TetMesh split(test::with_copies(data, cell_tets, test::no_jump), "split");
            for (const OrderMethod method : {OrderMethod::mpvo, OrderMethod::exact}) {
                VisibilityOrder one(shared, method), other(split, method);
                for (const Eye& eye : test::eyes(shared, 4)) {
                    EXPECT_TRUE(std::ranges::equal(other.sort(eye), one.sort(eye)))
                        << cell_tets << " " << name_of(method);
                    EXPECT_EQ(other.report().cycles, one.report().cycles);
                }
            }
        }
    }
}

// Tests face_violations() itself: a reversed order breaks every face that is not edge-on.
TEST(OrderCheck, CountsEveryWrongFace) {
    const TetMesh mesh(test::DelaunayMesh::make(300, 2), "delaunay");
    const Eye eye{{.3, -2, .4}};
    std::int64_t hiding = 0;
    for (std::size_t tet = 0; tet < mesh.tets().size(); ++tet) {
        for (std::size_t face = 0; face < 4; ++face) {
            const auto [a, b, c] = corners_of_face(mesh.tets()[tet], face);
            const auto at = [&](std::int32_t i) {
                return mesh.points()[static_cast<std::size_t>(i)];
            };
            if (mesh.neighbors()[tet][face] != TetMesh::no_neighbor)
                hiding += sign_as_seen(eye, at(a), at(b), at(c)) > 0;
        }
    }
    VisibilityOrder sorter(mesh, OrderMethod::mpvo);
    const auto sorted = sorter.sort(eye);
    std::vector<std::int32_t> order(sorted.begin(), sorted.end());
    EXPECT_EQ(face_violations(mesh, eye, order), 0);
    std::reverse(order.begin(), order.end());
    EXPECT_EQ(face_violations(mesh, eye, order), hiding);
    // A single tet at the wrong end breaks only its own faces.
    std::reverse(order.begin(), order.end());
    const FaceSigns signs = FaceSigner(mesh, eye).signs(static_cast<std::size_t>(order.front()));
    std::int64_t nearer = 0;
    for (std::size_t face = 0; face < 4; ++face) {
        nearer += mesh.neighbors()[static_cast<std::size_t>(order.front())][face] >= 0 &&
                  (signs & nearer_bit(face)) != 0;
    }
    std::rotate(order.begin(), order.begin() + 1, order.end());
    EXPECT_EQ(face_violations(mesh, eye, order), nearer);
}

TEST(OrderCheck, RefusesListsThatAreNoOrder) {
    const TetMesh mesh(test::kuhn_box({1, 1, 1}, test::no_scalar), "box");
    const std::vector<std::int32_t> few{0, 1, 2}, twice{0, 1, 2, 3, 4, 4}, beyond{0, 1, 2, 3, 4, 6};
    expect_error([&] { face_violations(mesh, {}, few); }, {"3", "6"});
    expect_error([&] { face_violations(mesh, {}, twice); }, {"place 5", "tet 4"});
    expect_error([&] { face_violations(mesh, {}, beyond); }, {"place 5", "tet 6"});
}

TEST(VisibilityOrder, CentroidSortsByDepthAndNoneKeepsTheList) {
    const TetMesh mesh(test::DelaunayMesh::make(500, 3), "delaunay");
    VisibilityOrder centroid(mesh, OrderMethod::centroid), none(mesh, OrderMethod::none);
    const auto depth = [&](std::int32_t tet) {
        glm::dvec3 sum(0);
        for (const std::int32_t corner : mesh.tets()[static_cast<std::size_t>(tet)])
            sum += mesh.points()[static_cast<std::size_t>(corner)];
        return sum.z;
    };
    const auto order = centroid.sort({{0, 0, 2}, true});
    EXPECT_TRUE(std::is_sorted(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
        return depth(a) > depth(b);
    }));
    EXPECT_GT(face_violations(mesh, {{0, 0, 2}, true}, order), 0);
    const auto listed = none.sort({{0, 0, 2}});
    for (std::size_t i = 0; i < listed.size(); ++i)
        EXPECT_EQ(listed[i], static_cast<std::int32_t>(i));
}

std::vector<std::int32_t> sorted_by(const TetMesh& mesh, OrderMethod method, const Eye& eye,
                                    std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    VisibilityOrder order(mesh, method);
    const auto sorted = order.sort(eye);
    return {sorted.begin(), sorted.end()};
}

TEST(VisibilityOrder, DependsOnMeshAndEyeAlone) {
    std::mt19937 random(3);
    const TetMesh mesh(test::carved(test::DelaunayMesh::make(400, 9),
                                    [&](const glm::dvec3&) { return random() % 3 > 0; }),
                       "sponge");
    for (const Eye& eye : {Eye{{2, .3, .1}}, Eye{{.2, .2, .2}}, Eye{{1, 2, 3}, true}}) {
        for (const OrderMethod method :
             {OrderMethod::mpvo, OrderMethod::exact, OrderMethod::centroid}) {
            const auto once = sorted_by(mesh, method, eye, 1);
            EXPECT_EQ(once, sorted_by(mesh, method, eye, 4)) << name_of(method);
            VisibilityOrder used(mesh, method);  // earlier calls of sort() leave no trace
            used.sort({{-5, 1, 0}});
            EXPECT_TRUE(std::ranges::equal(once, used.sort(eye))) << name_of(method);
        }
    }
}

// Memory for cycles is taken once, too, at the first view that has some.
TEST(VisibilityOrder, TakesItsMemoryOnce) {
    std::mt19937 random(3);
    const TetMesh sponge(test::carved(test::DelaunayMesh::make(200, 9),
                                      [&](const glm::dvec3&) { return random() % 3 > 0; }),
                         "sponge");
    const TetMesh cyclic(test::twisted_prism(20), "prism");
    for (const TetMesh* mesh : {&sponge, &cyclic}) {
        const std::vector<Eye> frames = test::eyes(*mesh, 2);
        for (const OrderMethod method :
             {OrderMethod::mpvo, OrderMethod::exact, OrderMethod::centroid, OrderMethod::none}) {
            VisibilityOrder order(*mesh, method);
            for (const Eye& eye : frames) order.sort(eye);
            const std::int64_t before = test::allocation_count();
            for (const Eye& eye : frames) order.sort(eye);
            EXPECT_EQ(test::allocation_count(), before) << name_of(method);
        }
    }
}

}  // namespace
}  // namespace lamina
