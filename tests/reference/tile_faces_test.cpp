// SPDX-License-Identifier: Apache-2.0
#include "reference/tile_faces.h"

#include <gtest/gtest.h>

#include <glm/glm.hpp>

#include "fixtures.h"
#include "mesh/ray_walk.h"
#include "reference/chord.h"
#include "support/split_box.h"

namespace lamina {
namespace {

using reference_test::camera_at;
using reference_test::make_grid;
using reference_test::Random;

double value_at(const glm::dvec3& p) {
    return p.x;
}

// Cameras outside, inside and at the surface of a box from `origin` on, as large as `size`.
std::vector<Camera> cameras_around(Random& random, const glm::dvec3& origin, double size) {
    std::vector<Camera> cameras;
    for (int i = 0; i < 60; ++i) {
        Camera camera;
        camera.projection = i % 2 == 0 ? Projection::perspective : Projection::orthographic;
        camera.eye = origin + size * (i % 3 == 0 ? random.point(0, 1) : random.point(-5, 6));
        camera.center = origin + size * random.point(0, 1);
        camera.up = random.point(-1, 1);
        camera.fov_y = random.uniform(1, 150);
        camera.height = size * std::pow(10, random.uniform(-1, 2));
        cameras.push_back(camera);
    }
    return cameras;
}

TEST(TileFaces, ListThoseThatLinesMeet) {
    const TetMesh mesh(test::split_box(7, 1000, .01, value_at), "box");
    const FaceTree tree(mesh, mesh.open_faces());
    Random random(3);
    std::size_t entries = 0, listed = 0;
    for (const Camera& camera : cameras_around(random, glm::dvec3(0), 1)) {
        const View view(camera, 45, 33);
        TileFaces faces(mesh, tree, view);
        RayWalk one(mesh, tree), other(mesh, tree);
        for (const PictureTile& tile : tiles_to_trace(view.width, view.height)) {
            ASSERT_TRUE(faces.list(tile));
            for (int i = 0; i < tile.width * tile.height; ++i) {
                const glm::ivec2 pixel(tile.column + i % tile.width, tile.row + i / tile.width);
                const View::Ray ray = view.ray(pixel.x, pixel.y);
                one.aim(ray.origin, ray.direction);
                other.aim(ray.origin, ray.direction, faces.of(pixel));
                ASSERT_EQ(one.entries().size(), other.entries().size());
                for (std::size_t e = 0; e < one.entries().size(); ++e)
                    ASSERT_EQ(one.entries()[e].at, other.entries()[e].at);
                ASSERT_EQ(one.overlapping(), other.overlapping());
                entries += one.entries().size();
                listed += faces.of(pixel).size();
            }
        }
    }
    EXPECT_GT(entries, 10000u);
    EXPECT_LT(listed, 20 * entries);  // not simply all of them
}

// 200 tets one behind the other in front of 1024 pixels.
TEST(TileFaces, AreNotListedWhereTheyAreTooMany) {
    MeshData data;
    data.point_scalars.push_back({"s", {}});
    for (int i = 0; i < 200; ++i) {
        const auto first = static_cast<std::int32_t>(data.points.size());
        for (const glm::dvec3& p : {glm::dvec3(-9, -9, 0), glm::dvec3(9, -9, 0),
                                    glm::dvec3(0, 20, 0), glm::dvec3(0, 0, .5)}) {
            data.points.push_back(p + glm::dvec3(0, 0, i));
            data.point_scalars[0].values.push_back(p.x);
        }
        data.tets.push_back({first, first + 1, first + 2, first + 3});
    }
    const TetMesh mesh(data, "tets");
    const FaceTree tree(mesh, mesh.open_faces());
    Camera camera;
    camera.eye = {0, 0, -3};
    const View view(camera, 32, 32);
    TileFaces faces(mesh, tree, view);
    EXPECT_FALSE(faces.list(tiles_to_trace(32, 32)[0]));
}

// Also of a box whose coordinates are large beside its size.
TEST(SeenPixels, HoldAllWhoseRaysMeetABox) {
    Random random(4);
    std::size_t hits = 0, misses = 0;
    for (const double origin : {0.0, 1e6}) {
        Grid grid = make_grid({5, 6, 7}, Centering::cell);
        grid.origin = glm::dvec3(origin, -origin, origin / 3);
        std::array<glm::dvec3, 8> corners;
        for (std::size_t i = 0; i < 8; ++i) {
            const glm::dvec3 lo = grid.index_min(), hi = grid.index_max();
            corners[i] =
                grid.to_world({i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 4 ? hi.z : lo.z});
        }
        for (const Camera& camera : cameras_around(random, grid.origin, 6)) {
            const View view(camera, 40, 30);
            const PictureTile tile{3, 5, 32, 20};
            const SeenPixels around = pixels_around(view, tile, corners);
            for (int row = 0; row < tile.height; ++row) {
                for (int column = 0; column < tile.width; ++column) {
                    const bool within = column >= around.first.x && column <= around.last.x &&
                                        row >= around.first.y && row <= around.last.y;
                    const bool met =
                        chord_length(grid, view, tile.column + column, tile.row + row) > 0;
                    ASSERT_TRUE(within || !met);
                    hits += met;
                    misses += !within;
                }
            }
        }
    }
    EXPECT_GT(hits, 1000u);
    EXPECT_GT(misses, 1000u);
}

}  // namespace
}  // namespace lamina
