// SPDX-License-Identifier: Apache-2.0
#include "slicing/trial_truth.h"

#include <algorithm>

#include "slicing_fixture.h"
#include "support/volume_of.h"
#include "volume/generate.h"

namespace lamina {
namespace {

// Returns a volume of zeros but for one sample of 255.
Volume one_bright_voxel(double x, double y, double z) {
    const Grid grid =
        generate({"constant", std::array<std::int64_t, 3>{33, 33, 33}, SampleType::uint8}).grid();
    return test::volume_of<std::uint8_t>(
        grid, [&](double i, double j, double k) { return i == x && j == y && k == z ? 255. : 0.; });
}

TEST(PointCover, CoversRaysThroughTheOnlyFeatureAndFewOthers) {
    const Volume volume = one_bright_voxel(20, 9, 14);
    const TransferFunction optics = TransferFunction::linear(
        {knot(100, {1, 1, 1}, 0), knot(101, {1, 1, 1}, 50), knot(102, {1, 1, 1}, 0)});
    for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
        const Scene scene = unit_box_scene(optics, projection);
        const View view(*scene.camera, scene.width, scene.height);
        const auto cover = cover_of_points(measure_bricks(volume), volume.grid(), optics, view);
        const Image picture = trace(volume, scene, 1e-6);
        ASSERT_EQ(cover.size() * 4, picture.rgba.size());
        int seen = 0;
        for (std::size_t i = 0; i < cover.size(); ++i) {
            if (picture.rgba[4 * i + 3] == 0) continue;
            ++seen;
            EXPECT_GE(cover[i], 1);
        }
        EXPECT_GT(seen, 0);
        // The sample belongs to at most eight bricks, which together are 8 of 32 cells wide on each
        // axis.
        EXPECT_LT(std::ranges::count_if(cover, [](float c) { return c > 0; }),
                  static_cast<std::ptrdiff_t>(cover.size() / 4));
    }
}

TEST(PointCover, CoversNothingWithoutPoints) {
    const Volume volume = one_bright_voxel(20, 9, 14);
    const TransferFunction optics =
        TransferFunction::linear({knot(-1, {1, 1, 1}, 0), knot(256, {1, 1, 1}, 50)});
    const Scene scene = unit_box_scene(optics, Projection::perspective);
    const auto cover = cover_of_points(measure_bricks(volume), volume.grid(), optics,
                                       View(*scene.camera, scene.width, scene.height));
    EXPECT_EQ(std::ranges::count(cover, 0.0f), static_cast<std::ptrdiff_t>(cover.size()));
}

}  // namespace
}  // namespace lamina
