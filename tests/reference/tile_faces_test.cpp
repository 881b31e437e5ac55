// SPDX-License-Identifier: Apache-2.0
#include "reference/tiles.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <vector>

#include "fixtures.h"
#include "mesh/predicates.h"
#include "mesh/ray_walk.h"
#include "reference/chord.h"
#include "support/split_box.h"

namespace lamina {
namespace {

using reference_test::make_grid;
using reference_test::Random;

double place_along_x(const glm::dvec3& p) {
    return p.x;
}

// Returns cameras outside, inside and on the surface of a box with the lowest corner `origin` and
// edges of `size`. The up vector of some is nearly parallel to the view direction, so that the
// view's axes are skewed.
std::vector<Camera> cameras_around(Random& random, const glm::dvec3& origin, double size) {
    std::vector<Camera> cameras;
    for (int i = 0; i < 90; ++i) {
        Camera camera;
        camera.projection = i % 2 == 0 ? Projection::perspective : Projection::orthographic;
        camera.eye = origin + size * (i % 3 == 0 ? random.point(0, 1) : random.point(-5, 6));
        camera.center = origin + size * random.point(0, 1);
        camera.up = random.point(-1, 1);
        if (i % 5 == 0)
            camera.up = glm::normalize(camera.center - camera.eye) + 1e-7 * random.point(-1, 1);
        camera.fov_y = i % 4 == 0 ? 1 : random.uniform(1, 150);
        camera.height = size * std::pow(10, random.uniform(-1, 2));
        cameras.push_back(camera);
    }
    // In this view, pixel centres lie on edges and points of whole-numbered meshes.
    Camera straight;
    straight.projection = Projection::orthographic;
    straight.eye = {4, 4, 20};
    straight.center = {4, 4, 0};
    straight.height = 8;
    cameras.push_back(straight);
    return cameras;
}

void expect_faces_listed(const TetMesh& mesh, const Camera& camera, std::size_t& entries,
                         std::size_t& listed, std::size_t& pixels) {
    const FaceTree tree(mesh, mesh.open_faces());
    const View view(camera, 48, 32);
    TileFaces faces(mesh, tree, view);
    RayWalk one(mesh, tree), other(mesh, tree);
    for (const PictureTile& tile : tiles_to_trace(view.width, view.height)) {
        if (!faces.list(tile)) continue;  // too many faces: an eye in the mesh
        for (int i = 0; i < tile.width * tile.height; ++i) {
            const glm::ivec2 pixel(tile.column + i % tile.width, tile.row + i / tile.width);
            const View::Ray ray = view.ray(pixel.x, pixel.y);
            one.aim(ray.origin, ray.direction);
            other.aim(ray.origin, ray.direction, faces.of(pixel));
            ASSERT_EQ(one.entries().size(), other.entries().size());
            for (std::size_t e = 0; e < one.entries().size(); ++e) {
                ASSERT_EQ(one.entries()[e].at, other.entries()[e].at);
                ASSERT_EQ(one.entries()[e].face.tet, other.entries()[e].face.tet);
            }
            ASSERT_EQ(one.overlapping(), other.overlapping());
            entries += one.entries().size();
            listed += faces.of(pixel).size();
            ++pixels;
        }
    }
}

// A box of 8^3 cells has 768 open faces, many smaller than a pixel.
TEST(TileFaces, ListThoseThatLinesMeet) {
    Random random(3);
    MeshData regular = test::kuhn_box({8, 8, 8}, place_along_x), irregular = regular;
    for (glm::dvec3& point : irregular.points) point += random.point(-.2, .2);
    std::size_t entries = 0, listed = 0, pixels = 0;
    for (const MeshData& data : {regular, irregular}) {
        const TetMesh mesh(data, "box");
        for (const Camera& camera : cameras_around(random, glm::dvec3(0), 8)) {
            expect_faces_listed(mesh, camera, entries, listed, pixels);
        }
    }
    EXPECT_GT(entries, 10000u);
    EXPECT_GT(pixels, 182 * 48 * 32 / 2);
    EXPECT_LT(listed, 768 * pixels / 10);  // of 768 faces
}

// The mesh has 200 tets one behind the other, in front of 1024 pixels.
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

// Boxes may have coordinates that are large compared with their size.
TEST(SeenPixels, HoldAllWhoseRaysMeetABox) {
    Random random(4);
    std::size_t hits = 0, misses = 0;
    for (const double origin : {0.0, 1e6}) {
        Grid grid = make_grid({5, 6, 7}, Centering::cell);
        grid.origin = glm::dvec3(origin, -origin, origin / 3);
        std::array<glm::dvec3, 8> corners = box_corners(grid.index_min(), grid.index_max());
        for (glm::dvec3& corner : corners) corner = grid.to_world(corner);
        for (const Camera& camera : cameras_around(random, grid.origin, 6)) {
            const View view(camera, 40, 30);
            const PictureTile tile{3, 5, 32, 20};
            const SeenPixels around = TileSight(view, tile).around(corners);
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

// Points on rays are seen in the rays' pixels, even if the view's axes are skewed.
TEST(SeenPixels, HoldThePixelsOfPointsOnRays) {
    Random random(5);
    for (const double tilt : {2e-9, 1e-7, 1e-5, 1e-3, 1.0}) {
        for (int i = 0; i < 2000; ++i) {
            Camera camera;
            camera.projection = i % 2 == 0 ? Projection::perspective : Projection::orthographic;
            camera.eye = random.point(-1, 1);
            camera.center = camera.eye + random.point(-1, 1);
            const glm::dvec3 along = glm::normalize(camera.center - camera.eye);
            camera.up = along + tilt * glm::normalize(glm::cross(along, random.point(-1, 1)));
            camera.fov_y = i % 3 == 0 ? 1 : 30;
            camera.height = .01;
            const View view(camera, 1000, 1000);
            const PictureTile tile{random.below(1000), random.below(1000), 1, 1};
            const View::Ray ray = view.ray(tile.column, tile.row);
            const std::array point{ray.origin + random.uniform(.1, 10) * ray.direction};
            ASSERT_FALSE(TileSight(view, tile).around(point).empty()) << tilt << " " << i;
        }
    }
}

}  // namespace
}  // namespace lamina
