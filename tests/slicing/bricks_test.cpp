// SPDX-License-Identifier: Apache-2.0
// Volumes that are cut into several textures.
#include "engine_fixture.h"
#include "reference/chord.h"
#include "slicing/slab_geometry.h"
#include "volume/generate.h"

namespace lamina {
namespace {

Capabilities with_small_textures(Capabilities capabilities, std::uint64_t bytes) {
    capabilities.max_texture_bytes = bytes;
    return capabilities;
}

std::vector<TextureBrick> bricks_of(const Volume& volume, const Scene& scene,
                                    const Capabilities& capabilities) {
    const Facts facts = measure(scene, volume, measure_bricks(volume));
    return make_plan(scene, facts, capabilities, {}).slice.bricks;
}

TEST_F(SlicingTest, BricksCoverEveryCellOnce) {
    const Volume volume =
        generate({"constant", std::array<std::int64_t, 3>{37, 20, 53}, SampleType::uint8});
    Scene scene =
        unit_box_scene(TransferFunction::linear({knot(0, {1, 1, 1}, 0), knot(255, {1, 1, 1}, 1)}),
                       Projection::perspective, 8, 8);
    OmissionSwitch nothing;
    nothing.none = true;
    const Facts facts = measure(scene, volume, measure_bricks(volume));
    const auto bricks =
        make_plan(scene, facts, with_small_textures(capabilities(), 4 * 3000), nothing)
            .slice.bricks;
    ASSERT_GT(bricks.size(), 8u);
    std::vector<int> times(36 * 19 * 52);
    for (const TextureBrick& brick : bricks) {
        EXPECT_LE(4 * brick.size[0] * brick.size[1] * brick.size[2], 4 * 3000);
        for (std::int64_t z = brick.first[2]; z < brick.first[2] + brick.size[2] - 1; ++z) {
            for (std::int64_t y = brick.first[1]; y < brick.first[1] + brick.size[1] - 1; ++y) {
                for (std::int64_t x = brick.first[0]; x < brick.first[0] + brick.size[0] - 1; ++x) {
                    ++times[static_cast<std::size_t>((z * 19 + y) * 36 + x)];
                }
            }
        }
    }
    EXPECT_EQ(std::count(times.begin(), times.end(), 1), 36 * 19 * 52);
}

TEST_F(SlicingTest, BricksComeInVisibilityOrderAlongEveryRay) {
    const Volume volume = gaussians(40);
    const Grid& grid = volume.grid();
    std::mt19937 random(7);
    std::uniform_real_distribution<double> place(-1, 2);
    for (int trial = 0; trial < 60; ++trial) {
        Scene scene = unit_box_scene(
            smooth_transfer_function(),
            trial % 2 == 0 ? Projection::perspective : Projection::orthographic, 16, 16);
        scene.camera->eye = {place(random), place(random), place(random)};
        scene.camera->fov_y = 120;
        const View view(*scene.camera, scene.width, scene.height);
        const auto bricks = bricks_of(volume, scene, with_small_textures(capabilities(), 4 * 4000));
        ASSERT_GT(bricks.size(), 10u);
        std::vector<std::size_t> order;
        set_visibility_order(bricks, grid, view, Order::front_to_back, order);
        for (int row = 0; row < 16; ++row) {
            const View::Ray ray = view.ray(row, (row * 5) % 16);
            double last = 0;
            for (const std::size_t brick : order) {
                // Clips the ray to the brick in index space, in double precision.
                const IndexBox box = box_of(bricks[brick], grid);
                const glm::dvec3 origin = grid.to_index(ray.origin),
                                 direction = grid.direction_to_index(ray.direction);
                double enter = 0, leave = INFINITY;
                for (int axis = 0; axis < 3; ++axis) {
                    const double a = (box.min[axis] - origin[axis]) / direction[axis];
                    const double b = (box.max[axis] - origin[axis]) / direction[axis];
                    enter = std::max(enter, std::min(a, b));
                    leave = std::min(leave, std::max(a, b));
                }
                if (leave - enter < 1e-9) continue;
                EXPECT_GE(enter, last - 1e-9) << "trial " << trial;
                last = leave;
            }
        }
    }
}

// Cutting a volume into bricks divides segments at the bricks' faces and changes nothing else. Both
// pictures have an error of second order, here below .2 / 255. A seam (a layer drawn twice or not
// at all) would cost the colour of a full segment, over 1 / 255.
TEST_P(BothEngines, BricksLeaveNoSeam) {
    const Volume volume = gaussians(40);
    for (const Classification classification :
         {Classification::post, Classification::preintegrated}) {
        for (const Order order : {Order::back_to_front, Order::front_to_back}) {
            Scene scene = unit_box_scene(smooth_transfer_function(), Projection::perspective);
            scene.slice.samples = 200;
            scene.slice.classification = classification;
            scene.slice.order = order;
            const auto small = with_small_textures(capabilities(), 16 * 64 * 48 + 4 * 1000);
            for (const OmissionSwitch& omissions : {OmissionSwitch{}, keep("blending")}) {
                EXPECT_LE(
                    linf(draw(volume, scene, omissions), draw(volume, scene, omissions, small)),
                    .2);
            }
        }
    }
}

TEST_F(SlicingTest, BricksOfAHomogeneousBoxGiveTheExactChord) {
    const Volume volume =
        generate({"constant", std::array<std::int64_t, 3>{20, 30, 25}, SampleType::uint8});
    Scene scene =
        unit_box_scene(TransferFunction::linear({knot(0, {1, 1, 1}, 3)}), Projection::perspective);
    scene.slice.samples = 40;
    const Image image =
        render(volume, scene, with_small_textures(capabilities(), 16 * 64 * 48 + 4 * 1000),
               leave_nothing_out());
    const View view(*scene.camera, scene.width, scene.height);
    double worst = 0;
    for (int row = 0; row < view.height; ++row) {
        for (int column = 0; column < view.width; ++column) {
            const double chord = chord_length(volume.grid(), view, column, row);
            worst = std::max(worst, std::abs(image.pixel(column, row)[3] + std::expm1(-3 * chord)));
        }
    }
    // The optical depth is up to 5; some 70 segments have float32 lengths good to 1e-6 of the box.
    EXPECT_LE(worst, 3e-5);
}

}  // namespace
}  // namespace lamina
