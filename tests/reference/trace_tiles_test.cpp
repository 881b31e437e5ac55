// SPDX-License-Identifier: Apache-2.0
#include "reference/tiles.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/glm.hpp>

#include "fixtures.h"
#include "reference/tracer.h"
#include "support/split_box.h"
#include "support/transfer_functions.h"

namespace lamina {
namespace {

using reference_test::camera_at;
using reference_test::make_grid;
using reference_test::make_volume;

TEST(TraceTiles, CoverThePictureOnceFromTheMiddleOutwards) {
    for (const auto& [width, height] : {std::pair{100, 70}, {1, 1}, {32, 64}, {33, 2}}) {
        std::vector<int> covered(static_cast<std::size_t>(width * height));
        double before = 0;
        for (const PictureTile& tile : tiles_to_trace(width, height)) {
            for (int row = tile.row; row < tile.row + tile.height; ++row)
                for (int column = tile.column; column < tile.column + tile.width; ++column)
                    ++covered.at(static_cast<std::size_t>(row * width + column));
            const double distance = std::hypot(tile.column + .5 * tile.width - .5 * width,
                                               tile.row + .5 * tile.height - .5 * height);
            EXPECT_GE(distance, before);
            before = distance;
        }
        EXPECT_EQ(covered, std::vector<int>(covered.size(), 1));
    }
}

// Keeps the pixels of each tile as they are when the tile is reported as done.
struct Keeper {
    PreciseImage kept;
    int tiles = 0;
    TileDone listener() {
        return [this](const PictureTile& tile, const PreciseImage& picture) {
            ++tiles;
            if (kept.width == 0) kept = PreciseImage(picture.width, picture.height);
            for (int row = tile.row; row < tile.row + tile.height; ++row)
                for (int i = 0; i < 4 * tile.width; ++i)
                    kept.pixel(tile.column, row)[i] = picture.pixel(tile.column, row)[i];
        };
    }
};

TEST(TraceTiles, AreCompleteWhenTheyAreReported) {
    const Grid box = make_grid({3, 3, 3}, Centering::node);
    std::vector<float> samples;
    for (int i = 0; i < 27; ++i)
        samples.push_back(.5f + .5f * std::sin(5.f * static_cast<float>(i)));
    const Volume volume = make_volume(box, samples);
    const View view(camera_at(box, Projection::perspective, {.3, .2, 1}, 1.2), 70, 50);
    Keeper of_volume;
    const TraceResult traced = trace_volume(volume, test::smooth(), view, {}, of_volume.listener());
    EXPECT_EQ(of_volume.tiles, 6);  // 3 x 2
    EXPECT_EQ(of_volume.kept.rgba, traced.image.rgba);
    // Compares with pixels that are traced one by one, without tiles.
    std::vector<glm::ivec2> pixels;
    for (int row = 0; row < view.height; ++row)
        for (int column = 0; column < view.width; ++column) pixels.emplace_back(column, row);
    const TracedPixels alone = trace_pixels(volume, test::smooth(), view, pixels, {});
    for (std::size_t i = 0; i < pixels.size(); ++i)
        for (std::size_t c = 0; c < 4; ++c)
            ASSERT_EQ(alone.rgba[i][static_cast<int>(c)], traced.image.rgba[4 * i + c]);

    const TetMesh mesh(test::kuhn_box({2, 2, 2}, [](const glm::dvec3& p) { return p.x * p.y / 4; }),
                       "box");
    const FaceTree open_faces(mesh, mesh.open_faces());
    Keeper of_mesh;
    const TraceResult meshed = trace_mesh(mesh, open_faces, mesh.point_scalars()[0].values,
                                          test::smooth(), view, {}, of_mesh.listener());
    EXPECT_EQ(of_mesh.tiles, 6);
    EXPECT_EQ(of_mesh.kept.rgba, meshed.image.rgba);
}

}  // namespace
}  // namespace lamina
