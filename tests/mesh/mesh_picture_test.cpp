// SPDX-License-Identifier: Apache-2.0
#include "mesh/mesh_picture.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/split_box.h"

namespace lamina {
namespace {

using Codes = std::array<int, 3>;

Codes pixel(const CodedImage& image, int column, int row) {
    const auto first = static_cast<std::size_t>(3 * (row * image.width + column));
    return {image.codes[first], image.codes[first + 1], image.codes[first + 2]};
}

constexpr int side = 64;
constexpr int room = 8;
constexpr Codes paper{255, 255, 255}, lowest{68, 1, 84}, highest{253, 231, 37};

// The mesh is a box 4 x 2 x 2 with the scalar x. The cut across x shows its middle value
// everywhere. The cuts across y and z run from the lowest colour at the left to the highest at the
// right, and fill twice as many columns as rows.
TEST(MeshPicture, CutsShowTheScalar) {
    const TetMesh mesh(test::kuhn_box({4, 2, 2}, [](const glm::dvec3& p) { return p.x; }), "box");
    const CodedImage image = mesh_picture(mesh, mesh.point_scalars()[0].values, {0, 4}, side);
    ASSERT_EQ(image.width, 2 * side + 3 * room);
    ASSERT_EQ(image.height, image.width);
    const int second = side + 2 * room;
    for (const auto& [left, top] : {std::pair(room, second), std::pair(second, second)}) {
        int rows = 0, columns = 0;
        for (int i = 0; i < side; ++i) {
            rows += pixel(image, left + side / 4, top + i) != paper;
            columns += pixel(image, left + i, top + side / 2) != paper;
        }
        EXPECT_EQ(columns, side);
        EXPECT_EQ(rows, side / 2);
        // The pixel's centre is half a pixel from the edge: a 128th of the range, up to 8 codes a
        // channel.
        const Codes first = pixel(image, left, top + side / 2 + 3);
        const Codes last = pixel(image, left + side - 1, top + side / 2 + 3);
        for (std::size_t c = 0; c < 3; ++c) {
            EXPECT_NEAR(first[c], lowest[c], 8);
            EXPECT_NEAR(last[c], highest[c], 8);
        }
    }
    const Codes middle = pixel(image, second + side / 2 + 5, room + side / 2 + 9);
    EXPECT_EQ(middle, (Codes{33, 145, 140}));
}

TEST(MeshPicture, ShowsTheBoundaryAndMarksMissingValues) {
    MeshData data = test::kuhn_box({1, 1, 1}, [](const glm::dvec3&) { return 0; });
    data.point_scalars[0].values.assign(8, NAN);
    const TetMesh mesh(data, "box");
    const CodedImage image = mesh_picture(mesh, mesh.point_scalars()[0].values, {1, 0}, side);
    EXPECT_EQ(pixel(image, room, room), paper);  // the box's corner is no corner of the picture
    const Codes front = pixel(image, room + side / 2, room + side / 2 + 6);
    EXPECT_GT(front[0], 100);  // red, in the light that falls on the face
    EXPECT_LT(front[1], 40);
    EXPECT_NO_THROW(mesh_picture(mesh, {}, {0, 0}, side));  // a mesh without scalars
}

}  // namespace
}  // namespace lamina
