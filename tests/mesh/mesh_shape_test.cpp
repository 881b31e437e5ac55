// SPDX-License-Identifier: Apache-2.0
#include "mesh/mesh_shape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/glm.hpp>
#include <numbers>

#include "mesh/tet_overlaps.h"
#include "support/carved_mesh.h"
#include "support/delaunay_mesh.h"
#include "support/split_box.h"

namespace lamina {
namespace {

double nothing(const glm::dvec3&) {
    return 0;
}

MeshData box(const std::array<std::int32_t, 3>& cells) {
    return test::kuhn_box(cells, nothing);
}

Convexity convexity_of(const MeshData& data) {
    return convexity(TetMesh(data, "mesh"));
}

TEST(MeshShape, ConvexMeshesAreRecognized) {
    EXPECT_EQ(convexity_of(box({3, 2, 4})), Convexity::exact);
    EXPECT_EQ(convexity_of(test::DelaunayMesh::make(200, 1)), Convexity::exact);
    EXPECT_EQ(convexity_of(test::twisted_prism(-20)), Convexity::exact);
}

// Returns p turned about two axes.
glm::dvec3 turned_twice(const glm::dvec3& p, double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    const glm::dvec3 q(c * p.x - s * p.y, s * p.x + c * p.y, p.z);
    return {q.x, c * q.y - s * q.z, s * q.y + c * q.z};
}

// The sides of a box that is turned by an irrational angle are flat only up to 1e-16.
TEST(MeshShape, RoundedBoxesAreConvexWithinRounding) {
    MeshData turned = box({5, 5, 5});
    for (glm::dvec3& p : turned.points)
        p = {std::cos(1.) * p.x - std::sin(1.) * p.y, std::sin(1.) * p.x + std::cos(1.) * p.y, p.z};
    EXPECT_EQ(convexity_of(turned), Convexity::within_rounding);
    for (const double angle : {.3, .7, 1.3, 2.1, 2.9}) {
        MeshData stretched = box({9, 4, 14});
        for (glm::dvec3& p : stretched.points)
            p = turned_twice(p * glm::dvec3(1, 1e-4, 300), angle) + 100.;
        EXPECT_EQ(convexity_of(stretched), Convexity::within_rounding) << angle;
    }
    // A dent of 1e-9 counts.
    MeshData dented = box({2, 2, 2});
    dented.points[4].z += 1e-9;  // the middle of the side z = 0
    EXPECT_EQ(convexity_of(dented), Convexity::none);
    dented.points[4].z -= 2e-9;
    EXPECT_EQ(convexity_of(dented), Convexity::none);  // its diagonals fold the other way
    dented = box({2, 2, 2});
    dented.points[4].z += 1e-14;
    EXPECT_EQ(convexity_of(dented), Convexity::within_rounding);
}

// Returns the tets between a point above, one below, and the sides of a star with n points that is
// drawn `around` times around its middle: a pentagram for 5 and 2. For 1, it is convex.
MeshData bipyramid(int n, int around) {
    MeshData mesh;
    mesh.points = {{0, 0, 1}, {0, 0, -1}};
    for (int i = 0; i < n; ++i) {
        const double angle = 2 * std::numbers::pi * around * i / n;
        mesh.points.emplace_back(std::cos(angle), std::sin(angle), 0);
        mesh.tets.push_back({0, 1, 2 + i, 2 + (i + 1) % n});
    }
    return mesh;
}

TEST(MeshShape, SurfacesThatWindTwiceAreNotConvex) {
    EXPECT_EQ(convexity_of(bipyramid(5, 1)), Convexity::exact);
    for (const auto& [n, around] : {std::pair(5, 2), std::pair(7, 2), std::pair(7, 3)}) {
        const TetMesh star(bipyramid(n, around), "star");
        EXPECT_EQ(star.findings().boundary_faces, 2 * n);
        EXPECT_EQ(star.findings().folded_faces, 0);
        EXPECT_EQ(convexity(star), Convexity::none);
        EXPECT_FALSE(find_overlaps(star, 100).pairs.empty());
        // Turning a star to another axis does not make it convex.
        MeshData turned = bipyramid(n, around);
        for (glm::dvec3& point : turned.points) point = {point.z, -point.y, point.x};
        EXPECT_EQ(convexity_of(turned), Convexity::none);
    }
}

// A limacon, drawn once, has a loop inside: all edges of its bipyramid are convex, and along most
// directions only one point is higher than its neighbours, but it is covered twice there.
TEST(MeshShape, BipyramidsOverALimaconAreNotConvex) {
    MeshData mesh;
    mesh.points = {{.15, 0, .4}, {.15, 0, -.4}};
    for (int i = 0; i < 11; ++i) {
        const double t = 2 * std::numbers::pi * i / 11 + .013, r = .7 + std::cos(t);
        mesh.points.emplace_back(r * std::cos(t), r * std::sin(t), 0);
        mesh.tets.push_back({0, 1, 2 + i, 2 + (i + 1) % 11});
    }
    const TetMesh limacon(mesh, "limacon");
    EXPECT_EQ(limacon.findings().boundary_faces, 22);
    EXPECT_EQ(limacon.findings().folded_faces, 0);
    EXPECT_FALSE(find_overlaps(limacon, 100).pairs.empty());
    for (const double angle : {0., .4, 1., 1.7, 2.9}) {
        MeshData other = mesh;
        for (glm::dvec3& point : other.points) point = turned_twice(point, angle);
        EXPECT_EQ(convexity_of(other), Convexity::none) << angle;
    }
}

// Returns a prism whose base's corners are drawn `around` times around its middle, which is a point
// of top and bottom, too. Corners of the second turn are farther round by `shift` of a step.
MeshData prism(int around, double shift) {
    const int n = 6 * around;
    MeshData mesh;
    mesh.points = {{0, 0, 0}, {0, 0, 1}};
    for (int i = 0; i < n; ++i) {
        const double step = i + shift * (i < 6 ? i : 12 - i) / 6;
        const double angle = std::numbers::pi / 3 * step;
        const double radius = i < 6 ? 1 : .875;  // so that no points coincide
        for (const double z : {0., 1.})
            mesh.points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
        const std::int32_t p = 2 + 2 * i, q = 2 + 2 * ((i + 1) % n);
        mesh.tets.insert(mesh.tets.end(),
                         {{0, p, q, q + 1}, {0, p, p + 1, q + 1}, {0, 1, p + 1, q + 1}});
    }
    return mesh;
}

// Fans of faces in one plane may go round a point twice. The second turn meets the first one's
// neighbours at equal angles, or halfway between.
TEST(MeshShape, FlatFansThatTurnTwiceAreNotConvex) {
    for (const double angle : {0., .4, 1.3}) {
        MeshData mesh = prism(1, 0);
        for (glm::dvec3& point : mesh.points) point = turned_twice(point, angle);
        EXPECT_NE(convexity_of(mesh), Convexity::none) << angle;
        for (const double shift : {0., .5}) {
            mesh = prism(2, shift);
            EXPECT_EQ(TetMesh(mesh, "prism").findings().folded_faces, 0);
            for (glm::dvec3& point : mesh.points) point = turned_twice(point, angle);
            EXPECT_EQ(convexity_of(mesh), Convexity::none) << angle << " " << shift;
        }
    }
}

// Twelve pentagons that cross (Poinsot): each has a point of an icosahedron's five neighbours of a
// point as its corners. All edges are convex; it is no sphere, and its inside is covered thrice.
TEST(MeshShape, AGreatDodecahedronIsNotConvex) {
    MeshData mesh;
    const double golden = .5 * (1 + std::sqrt(5.));
    for (const double a : {-1., 1.}) {
        for (const double b : {-golden, golden})
            mesh.points.insert(mesh.points.end(), {{0, a, b}, {a, b, 0}, {b, 0, a}});
    }
    const auto points = mesh.points;
    const auto middle = static_cast<std::int32_t>(points.size());
    mesh.points.emplace_back(0, 0, 0);
    for (std::int32_t top = 0; top < middle; ++top) {
        glm::dvec3 sum(0);
        std::vector<std::int32_t> around;
        for (std::int32_t i = 0; i < middle; ++i) {
            if (std::abs(glm::distance(points[i], points[top]) - 2) > .1) continue;
            around.push_back(i);
            sum += points[i];
        }
        ASSERT_EQ(around.size(), 5);
        const auto face = static_cast<std::int32_t>(mesh.points.size());
        mesh.points.push_back(.2 * sum);
        for (const std::int32_t a : around) {
            for (const std::int32_t b : around)
                if (a < b && glm::distance(points[a], points[b]) < 2.1)
                    mesh.tets.push_back({middle, face, a, b});
        }
    }
    ASSERT_EQ(mesh.tets.size(), 60);
    const TetMesh star(mesh, "star");
    EXPECT_EQ(star.findings().boundary_faces, 60);
    EXPECT_EQ(star.findings().folded_faces, 0);
    EXPECT_EQ(convexity(star), Convexity::none);
    EXPECT_FALSE(find_overlaps(star, 2000).pairs.empty());
}

TEST(MeshShape, NonconvexMeshesAreRecognized) {
    const auto carved = [](const auto& keep) {
        return convexity_of(test::carved(box({3, 3, 3}), keep));
    };
    EXPECT_EQ(carved([](const auto& c) { return c.x < 1 || c.y < 1; }), Convexity::none);  // an L
    EXPECT_EQ(carved([](const auto& c) { return c.x < 1 || c.x > 2; }),
              Convexity::none);           // two boxes
    EXPECT_EQ(carved([](const auto& c) {  // a cavity
                  return glm::any(glm::greaterThan(glm::abs(c - 1.5), glm::dvec3(.5)));
              }),
              Convexity::none);
    EXPECT_EQ(carved([](const auto& c) {  // two boxes that touch along an edge
                  return (c.x < 1) == (c.y < 1);
              }),
              Convexity::none);
    EXPECT_EQ(convexity_of(test::twisted_prism(20)), Convexity::none);
    // A box with a smaller one inside: two surfaces. A box twice, at one place: its tets are
    // duplicates, and are dropped.
    MeshData twice = box({1, 1, 1});
    const MeshData once = twice;
    for (const glm::dvec3& point : once.points) twice.points.push_back(.5 * point + .25);
    for (Tet tet : once.tets) {
        for (std::int32_t& corner : tet) corner += 8;
        twice.tets.push_back(tet);
    }
    EXPECT_EQ(convexity_of(twice), Convexity::none);
    std::ranges::copy(once.points, twice.points.begin() + 8);
    EXPECT_EQ(convexity_of(twice), Convexity::exact);
}

TEST(MeshShape, EdgeRatioIsLongestOverShortest) {
    // Edges of unit cubes: 1 to sqrt(3).
    EXPECT_NEAR(edge_lengths(TetMesh(box({2, 2, 2}), "box")).ratio(), std::sqrt(3.), 1e-15);
    MeshData data;
    data.points = {{0, 0, 0}, {4, 0, 0}, {0, 3, 0}, {0, 0, .5}};
    data.tets = {{0, 1, 2, 3}};
    EXPECT_EQ(edge_lengths(TetMesh(data, "tet")).ratio(), 10);
    // Two inner points at one place, and tets between them: no face is open at these points. A box
    // beside them makes points fewer than half as many as tets: copies inside are not looked for.
    const MeshData beside = box({3, 3, 3});
    data.points.insert(data.points.end(), 2, glm::dvec3(.5, .5, .1));
    data.tets = {{0, 4, 2, 3}, {0, 1, 4, 3}, {0, 1, 2, 4}, {5, 1, 2, 3},
                 {4, 5, 2, 3}, {4, 1, 5, 3}, {4, 1, 2, 5}};
    for (const Tet& tet : beside.tets)
        data.tets.push_back({tet[0] + 6, tet[1] + 6, tet[2] + 6, tet[3] + 6});
    for (const glm::dvec3& point : beside.points) data.points.push_back(point + 10.);
    EXPECT_EQ(edge_lengths(TetMesh(data, "tets")).ratio(), INFINITY);
}

}  // namespace
}  // namespace lamina
