// SPDX-License-Identifier: Apache-2.0
#include "reference/order_pixels.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <glm/glm.hpp>
#include <memory>
#include <numbers>
#include <random>

#include "mesh/mesh_shape.h"
#include "mesh_files/mesh_file.h"
#include "support/carved_mesh.h"
#include "support/delaunay_mesh.h"
#include "support/split_box.h"
#include "visibility/visibility_order.h"

namespace lamina {
namespace {

double nothing(const glm::dvec3&) {
    return 0;
}

// Returns views from around the mesh and from inside it, with and without perspective.
std::vector<View> views(const TetMesh& mesh, int rounds, int size) {
    std::mt19937 random(8);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto vector = [&] {
        return glm::dvec3(uniform(random), uniform(random), uniform(random));
    };
    const glm::dvec3 center = .5 * (mesh.bounds().min + mesh.bounds().max),
                     extent = mesh.bounds().max - mesh.bounds().min;
    std::vector<View> all;
    for (int i = 0; i < rounds; ++i) {
        Camera camera;
        camera.up = vector();
        camera.center = center;
        camera.eye = center + 1.3 * glm::length(extent) * glm::normalize(vector());
        all.emplace_back(camera, size, size);
        camera.projection = Projection::orthographic;
        camera.height = glm::length(extent);
        all.emplace_back(camera, size, size);
        camera.projection = Projection::perspective;
        camera.fov_y = 100;
        camera.eye = center + .5 * extent * vector();
        camera.center = camera.eye + vector();
        all.emplace_back(camera, size, size);
    }
    return all;
}

OrderPixels judge(const TetMesh& mesh, OrderMethod method, const std::vector<View>& all) {
    const FaceTree tree(mesh, mesh.open_faces());
    VisibilityOrder order(mesh, method);
    const VisibilityOrder* const orders[] = {&order};
    OrderPixels sum;
    for (const View& view : all) {
        order.sort(eye_of(view));
        const OrderPixels found = judge_pixels(mesh, tree, view, orders)[0];
        sum.covered += found.covered;
        sum.wrong += found.wrong;
        sum.outside_cycles += found.outside_cycles;
        sum.overlapping += found.overlapping;
    }
    return sum;
}

void expect_none_wrong(const MeshData& data, OrderMethod method, int rounds) {
    const TetMesh mesh(data, "mesh");
    const OrderPixels found = judge(mesh, method, views(mesh, rounds, 40));
    EXPECT_GT(found.covered, 500 * rounds);
    EXPECT_EQ(found.wrong, 0);
}

template <typename Keep>
MeshData carved_box(const std::array<std::int32_t, 3>& cells, const Keep& keep) {
    return test::carved(test::kuhn_box(cells, nothing), keep);
}

// Two tets, one behind the other, drawn in both orders.
TEST(OrderPixels, AreWrongIfTwoTetsAreDrawnInTheWrongOrder) {
    MeshData data;
    data.points = {{-3, -3, 0}, {3, -3, 0}, {0, 3, 0}, {0, 0, 1}};
    for (int i = 0; i < 4; ++i)
        data.points.push_back(data.points[static_cast<std::size_t>(i)] + glm::dvec3(0, 0, 5));
    data.tets = {{0, 1, 2, 3}, {4, 5, 6, 7}};
    const TetMesh mesh(data, "tets");
    for (const double z : {-20., 20.}) {
        Camera camera;
        camera.eye = {.1, .1, z};
        camera.projection = Projection::orthographic;
        camera.height = 6;
        const std::vector<View> all{View(camera, 30, 30)};
        // The order as listed is right for an eye that has the second tet nearer.
        const OrderPixels listed = judge(mesh, OrderMethod::none, all);
        // The triangle covers half of its square of 36: 18 of 36.
        EXPECT_NEAR(static_cast<double>(listed.covered), 450, 30);
        EXPECT_EQ(listed.wrong, z > 0 ? 0 : listed.covered);
        EXPECT_EQ(listed.outside_cycles, listed.wrong);
        EXPECT_EQ(listed.overlapping, 0);
        EXPECT_EQ(judge(mesh, OrderMethod::exact, all).wrong, 0);
        EXPECT_EQ(judge(mesh, OrderMethod::mpvo, all).wrong, 0);
        EXPECT_EQ(judge(mesh, OrderMethod::centroid, all).wrong, 0);
    }
}

TEST(OrderPixels, AreRightForConvexMeshes) {
    expect_none_wrong(test::DelaunayMesh::make(1500, 3), OrderMethod::mpvo, 2);
    expect_none_wrong(test::kuhn_box({6, 5, 7}, nothing), OrderMethod::mpvo, 2);
    expect_none_wrong(test::DelaunayMesh::make(300, 3), OrderMethod::exact, 1);
    const TetMesh mesh(test::DelaunayMesh::make(300, 3), "delaunay");
    EXPECT_GT(judge(mesh, OrderMethod::centroid, views(mesh, 1, 40)).wrong, 0);
}

TEST(OrderPixels, AreRightForNonconvexMeshes) {
    const auto l_shape = [](const glm::dvec3& c) { return c.x < 2 || c.y < 2; };
    const auto ring = [](const glm::dvec3& c) { return c.x < 2 || c.x > 4 || c.y < 2 || c.y > 4; };
    const auto boxes = [](const glm::dvec3& c) { return c.x < 2 || c.x > 3; };
    const auto touching = [](const glm::dvec3& c) { return (c.x < 3) == (c.y < 3); };
    const auto shells = [](const glm::dvec3& c) {  // a box in the cavity of another
        const glm::dvec3 d = glm::abs(c - 3.);
        const double distance = std::max({d.x, d.y, d.z});
        return distance < 1 || distance > 2;
    };
    const auto comb = [](const glm::dvec3& c) { return c.z < 1 || static_cast<int>(c.x) % 2 == 0; };
    expect_none_wrong(carved_box({6, 6, 2}, l_shape), OrderMethod::exact, 3);
    expect_none_wrong(carved_box({6, 6, 2}, ring), OrderMethod::exact, 3);
    expect_none_wrong(carved_box({5, 3, 3}, boxes), OrderMethod::exact, 3);
    expect_none_wrong(carved_box({6, 6, 2}, touching), OrderMethod::exact, 3);
    expect_none_wrong(carved_box({6, 6, 6}, shells), OrderMethod::exact, 3);
    expect_none_wrong(carved_box({7, 3, 4}, comb), OrderMethod::exact, 3);
    std::mt19937 random(3);
    const MeshData sponge = test::carved(test::DelaunayMesh::make(250, 9),
                                         [&](const glm::dvec3&) { return random() % 3 > 0; });
    expect_none_wrong(sponge, OrderMethod::exact, 2);
    // If the guess of Williams's method does not hold, wrong pixels are counted.
    const TetMesh mesh(sponge, "sponge");
    EXPECT_GT(judge(mesh, OrderMethod::mpvo, views(mesh, 1, 40)).wrong, 0);
}

// Views along the axes have rays exactly in the planes of faces and through edges and points.
TEST(OrderPixels, AreRightOnRaysInThePlanesOfFaces) {
    const TetMesh mesh(carved_box({6, 6, 6},
                                  [](const glm::dvec3& c) {
                                      return c.x < 2 || c.x > 4 || c.y < 2 || c.y > 4 || c.z < 1;
                                  }),
                       "box");
    std::vector<View> all;
    for (const Projection projection : {Projection::orthographic, Projection::perspective}) {
        for (const glm::dvec3& eye : {glm::dvec3(3, 3, 20), glm::dvec3(20, 3, 3),
                                      glm::dvec3(3, 3, 3), glm::dvec3(20, 20, 20)}) {
            Camera camera;
            camera.projection = projection;
            camera.eye = eye;
            camera.center = {3, 3, -2};
            camera.up = {1, 2, 0};
            if (eye.z == 3 && eye.x == 20) camera.center = {3, 3, 3};
            camera.up = eye.x == 20 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0);
            camera.height = 8;  // a pixel is 1/4 wide: its centre is at a multiple of 1/8
            all.emplace_back(camera, 33, 33);
            all.emplace_back(camera, 32, 32);
        }
    }
    const OrderPixels found = judge(mesh, OrderMethod::exact, all);
    EXPECT_GT(found.covered, 3000);
    EXPECT_EQ(found.wrong, 0);
}

// A real cycle cannot be drawn right: only its pixels are wrong.
TEST(OrderPixels, AreWrongWithinCyclesOnly) {
    Camera above;
    above.eye = {0, 0, 9};
    above.projection = Projection::orthographic;
    above.height = 5;
    const std::vector<View> all{View(above, 200, 200)};
    for (const MeshData& data : {test::three_sticks({.3, .2, .25}), test::twisted_prism(20)}) {
        const TetMesh mesh(data, "cycle");
        const OrderPixels found = judge(mesh, OrderMethod::exact, all);
        EXPECT_GT(found.wrong, 0);
        EXPECT_EQ(found.outside_cycles, 0);
        // The broken area bounds the wrong pixels: a pixel has an area of (5/200)^2; those at the
        // border may add some (a border of at most 8 units crosses 8 * 200 / 5 pixels).
        VisibilityOrder exact(mesh, OrderMethod::exact);
        exact.sort(eye_of(all[0]));
        const double pixel = 5. / 200;
        EXPECT_LE(static_cast<double>(found.wrong) * pixel * pixel,
                  exact.report().broken_area + 8 * pixel);
    }
    // OrderMethod::none reports no cycles, so every wrong pixel counts as outside cycles.
    const TetMesh sticks(test::three_sticks({.3, .2, .25}), "sticks");
    const OrderPixels guessed = judge(sticks, OrderMethod::none, all);
    EXPECT_GT(guessed.wrong, 0);
    EXPECT_EQ(guessed.outside_cycles, guessed.wrong);
}

// In meshes of needles and slivers with holes, cycles are possible, and nothing is wrong outside
// them.
TEST(OrderPixels, AreRightOutsideCyclesOfNeedlesWithHoles) {
    for (const double least : {.1, 1e-3}) {
        std::mt19937 random(5);
        const TetMesh mesh(test::carved(test::split_box(3, 400, least, nothing),
                                        [&](const glm::dvec3&) { return random() % 4 > 0; }),
                           "needles");
        const OrderPixels found = judge(mesh, OrderMethod::exact, views(mesh, 3, 40));
        EXPECT_GT(found.covered, 1500);
        EXPECT_EQ(found.outside_cycles, 0) << least;
    }
}

std::filesystem::path data_file(const std::string& name) {
    const char* const data = std::getenv("LAMINA_DATA");
    return (data != nullptr ? std::filesystem::path(data)
                            : std::filesystem::path(LAMINA_SOURCE_DIR) / ".." / "shared" / "data") /
           name;
}

class RealMeshes : public testing::TestWithParam<const char*> {};

TEST_P(RealMeshes, ExactOrderHasNoWrongPixel) {
    const std::filesystem::path file = data_file(GetParam());
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "no " << file;
    const TetMesh mesh(read_mesh(file), GetParam());
    EXPECT_FALSE(convex(mesh));
    const std::vector<View> all = views(mesh, 1, 40);
    const OrderPixels exact = judge(mesh, OrderMethod::exact, all);
    EXPECT_GT(exact.covered, 500);
    EXPECT_EQ(exact.outside_cycles, 0);
    EXPECT_GT(judge(mesh, OrderMethod::centroid, all).wrong, 0);
}

INSTANTIATE_TEST_SUITE_P(OrderPixels, RealMeshes,
                         testing::Values("bluntfin.vtu", "combustor.vtu", "torso.vtu"),
                         [](const auto& mesh) {
                             return std::filesystem::path(mesh.param).stem().string();
                         });

// Parts of the can overlap: pixels are wrong only within cycles, or on rays on which parts overlap.
TEST(OrderPixels, OutsideCyclesAreWrongOnlyWherePartsOverlap) {
    const std::filesystem::path file = data_file("can.vtu");
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "no " << file;
    const TetMesh mesh(read_mesh(file), "can");
    const OrderPixels found = judge(mesh, OrderMethod::exact, views(mesh, 1, 40));
    EXPECT_EQ(found.outside_cycles, found.overlapping);
}

}  // namespace
}  // namespace lamina
