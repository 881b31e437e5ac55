// SPDX-License-Identifier: Apache-2.0
// Several renderers draw one picture together, each its share of the volume: their pictures,
// composited in the order of the shares, equal that of a single renderer.
#include <gtest/gtest.h>

#include <algorithm>

#include "cpu_fixture.h"
#include "exact_fixture.h"
#include "plan/volume_shares.h"
#include "support/put_behind.h"

namespace lamina {
namespace {

constexpr std::array<int, 5> counts{2, 3, 5, 8, 32};

// Returns the largest difference, in 1/255, that rounding and early termination allow. A single
// renderer sums blocks of slabs and runs of cells in double. With several, each share's sum is
// rounded to float (6e-8 of each channel), and so are sums composited behind one another. An opaque
// ray ends by its own optical depth, in each share as in one renderer; what lies behind changes a
// channel by at most max_error / 1024.
double tolerance(const Scene& scene, int shares) {
    return 255 * 6e-8 * 4 * (shares + 1) + scene.max_error * hidden_share * (shares + 1);
}

Image draw(const Volume& volume, const Scene& scene, const Facts& facts, const SlicePlan& plan) {
    CpuSliceRenderer renderer(volume, *scene.transfer_function, facts, plan, scene.width,
                              scene.height);
    renderer.draw(View(*scene.camera, scene.width, scene.height));
    return renderer.read();
}

double largest_difference(const PreciseImage& image, const Image& other) {
    double largest = 0;
    for (std::size_t i = 0; i < image.rgba.size(); ++i)
        largest = std::max(largest, std::abs(image.rgba[i] - double{other.rgba[i]}));
    return 255 * largest;
}

void expect_same_together(const Volume& volume, const Scene& scene, const char* what) {
    const MinMaxBricks bricks = measure_bricks(volume);
    const Facts facts = measure(scene, volume, bricks);
    const Plan plan = make_plan(scene, facts, cpu_capabilities(), {});
    const Image whole = draw(volume, scene, facts, plan.slice);
    EXPECT_GT(*std::ranges::max_element(whole.rgba), .1) << what;
    for (const int count : counts) {
        const VolumeShares shares(scene, facts, bricks, count % 2 == 1, count);
        ASSERT_EQ(shares.boxes().size(), static_cast<std::size_t>(count));
        PreciseImage together(scene.width, scene.height);
        for (const int number :
             shares.front_to_back(facts.grid, View(*scene.camera, scene.width, scene.height))) {
            SlicePlan of_share = plan.slice;
            of_share.share = shares.boxes()[static_cast<std::size_t>(number)];
            put_behind(draw(volume, scene, facts, of_share), together);
        }
        EXPECT_LE(largest_difference(together, whole), tolerance(scene, count))
            << what << ", shares: " << count;
    }
}

constexpr std::array<glm::dvec3, 4> directions{{{3, 2, 1}, {-1, 2, -3}, {0, 0, 1}, {-2, -.1, .5}}};

Scene scene_of(const Volume& volume, Classification classification, const glm::dvec3& direction) {
    Scene scene =
        unit_box_scene(in_view_of(volume, 20, many_points), Projection::perspective, 60, 45);
    scene.slice.classification = classification;
    look_from(volume, direction, 1.2, scene);
    return scene;
}

void expect_same_from_everywhere(const Volume& volume, Classification classification,
                                 const std::function<void(Scene&)>& change = {}) {
    for (const glm::dvec3& direction : directions) {
        Scene scene = scene_of(volume, classification, direction);
        if (classification != Classification::exact) scene.slice.samples = 70;
        if (change) change(scene);
        expect_same_together(volume, scene, "perspective");
        scene.camera->projection = Projection::orthographic;
        expect_same_together(volume, scene, "orthographic");
    }
}

const Volume& some_volume() {
    static const Volume volume = noise<std::uint8_t>({37, 30, 26}, Centering::node, 255);
    return volume;
}

TEST(VolumeShares, MakeOnePictureOfExactSegments) {
    expect_same_from_everywhere(some_volume(), Classification::exact);
}
TEST(VolumeShares, MakeOnePictureOfSlabs) {
    expect_same_from_everywhere(some_volume(), Classification::post);
}
TEST(VolumeShares, MakeOnePictureOfPreintegratedSlabs) {
    expect_same_from_everywhere(some_volume(), Classification::preintegrated);
}
TEST(VolumeShares, MakeOnePictureOfLitVolumes) {
    for (const auto classification : {Classification::exact, Classification::preintegrated}) {
        expect_same_from_everywhere(some_volume(), classification, [](Scene& scene) {
            scene.lighting = Lighting{};
            (*scene.lighting)->smallest_gradient = 1;
        });
    }
}
// A rounding may decide that a segment is cut because its light bends, and the cut changes the
// picture by more than a rounding. So walks must be the same to the last digit wherever they begin.
TEST(VolumeShares, CutLightThatBendsInTheSamePlaces) {
    const Volume waves = test::volume_of<std::uint8_t>(
        test::grid_of({72, 60, 50}, Centering::node), [](double x, double y, double z) {
            return std::round(120 * (1 + std::sin(.5 * x) * std::cos(.4 * y) * std::sin(.3 * z)));
        });
    for (const glm::dvec3& direction : directions) {
        Scene scene =
            unit_box_scene(in_view_of(waves, 20, steps), Projection::perspective, 180, 135);
        scene.slice.classification = Classification::exact;
        scene.lighting = Lighting{};
        (*scene.lighting)->smallest_gradient = 1;
        look_from(waves, direction, 1.2, scene);
        expect_same_together(waves, scene, "waves");
    }
}
TEST(VolumeShares, MakeOnePictureOfClippedVolumes) {
    for (const auto classification : {Classification::exact, Classification::post}) {
        expect_same_from_everywhere(some_volume(), classification, [](Scene& scene) {
            scene.clip.planes.push_back({{.4, .5, .6}, {.3, .5, .8}});
        });
    }
}
TEST(VolumeShares, MakeOnePictureOfSmallVolumes) {
    for (const std::array<std::int64_t, 3>& size :
         {std::array<std::int64_t, 3>{3, 3, 3}, {2, 9, 1}, {1, 1, 40}}) {
        for (const Centering centering : {Centering::cell, Centering::node}) {
            if (centering == Centering::node && std::ranges::min(size) == 1) continue;
            const Volume volume = noise<float>(size, centering, 1);
            expect_same_from_everywhere(volume, Classification::exact);
            expect_same_from_everywhere(volume, Classification::post);
        }
    }
}
TEST(VolumeShares, MakeOnePictureOfVolumesAroundTheEye) {
    for (const auto classification : {Classification::exact, Classification::preintegrated}) {
        Scene scene = scene_of(some_volume(), classification, {1, 2, 3});
        if (classification != Classification::exact) scene.slice.samples = 70;
        const Grid& grid = some_volume().grid();
        scene.camera->eye = grid.to_world(glm::dvec3(16, 16, 12.3));
        expect_same_together(some_volume(), scene, "eye inside, in a plane between shares");
    }
}

}  // namespace
}  // namespace lamina
