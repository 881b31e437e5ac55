// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "facts/volume_facts.h"
#include "plan/volume_shares.h"
#include "support/volume_of.h"
#include "volume/brick_cache.h"
#include "volume/min_max_bricks.h"

namespace lamina {
namespace {

constexpr int pages = 8;

// Returns a row of 8 bricks of the cache along x. All of the first brick is visible, and one sample
// of each other brick.
Volume row_of_pages() {
    constexpr auto edge = BrickCache::edge;
    const Grid grid = test::grid_of({pages * edge + 1, edge + 1, edge + 1}, Centering::node);
    return test::volume_of<std::uint8_t>(grid, [](double x, double y, double z) {
        const bool alone = std::fmod(x, edge) == 14 && y == 14 && z == 14;
        return x < edge || alone ? 255 : 0;
    });
}

// Returns a scene that looks along z, with 16 x 2 pixels. The four rays that meet the first brick
// of the cache cost at most 4 * (8 + 32) = 160 cells, less than reading one brick of the cache does
// (1900 cells); the other rays miss the single samples.
Scene scene_along_z() {
    Scene scene;
    scene.transfer_function =
        TransferFunction::linear({{0, {{1, 1, 1}, 0}}, {255, {{1, 1, 1}, 1e-4}}});
    Camera camera;
    camera.projection = Projection::orthographic;
    camera.eye = {128, 16, 200};
    camera.center = {128, 16, 0};
    camera.height = 36;
    scene.camera = camera;
    scene.width = 16;
    scene.height = 2;
    return scene;
}

// The second cuts count the bricks that are read, as the first one does.
TEST(SharedPages, AreAsManyInEachShareIfReadingCostsMost) {
    const Volume volume = row_of_pages();
    const Scene scene = scene_along_z();
    const MinMaxBricks bricks = measure_bricks(volume);
    const Facts facts = measure(scene, volume, bricks);
    for (const int count : {2, 4, 8}) {
        const VolumeShares shares(scene, facts, bricks, true, count);
        for (const IndexBox& box : shares.boxes()) {
            int inside = 0;
            for (int page = 0; page < pages; ++page) {
                const double middle = (page + .5) * BrickCache::edge;
                inside += box.min.x <= middle && middle < box.max.x;
            }
            EXPECT_EQ(inside, pages / count) << "from " << box.min.x << " to " << box.max.x;
        }
    }
}

}  // namespace
}  // namespace lamina
