// SPDX-License-Identifier: Apache-2.0
// Volumes whose field is constant in each sample's voxel ("lookup": "nearest").
#include <gtest/gtest.h>

#include <cmath>

#include "engine_fixture.h"
#include "exact_fixture.h"
#include "slicing/cpu_volume.h"
#include "support/stored_volume.h"

namespace lamina {
namespace {

class NearestLookup : public EngineTest {};

INSTANTIATE_TEST_SUITE_P(Contexts, NearestLookup, every_engine, engine_name);

Volume as_voxels(const Volume& volume) {
    Grid grid = volume.grid();
    grid.lookup = VolumeLookup::nearest;
    return volume.on(grid);
}

// Extinctions of the labels 0, 10, 20, 30; no label has the value of a step, 5, 15, 25.
constexpr double extinctions[] = {.5, 2, 0, .25};
TransferFunction of_labels() {
    std::vector<TransferKnot> knots{knot(0, {1, 1, 1}, extinctions[0])};
    for (int label = 1; label < 4; ++label) {
        const double step = 10 * label - 5;
        knots.push_back(knot(step, {1, 1, 1}, extinctions[label - 1]));
        knots.push_back(knot(step, {1, 1, 1}, extinctions[label]));
    }
    return TransferFunction::linear(knots);
}

Volume labels_along_x(Centering centering) {
    return as_voxels(test::volume_of<std::uint8_t>(
        test::grid_of({4, 3, 2}, centering), [](double x, double, double) { return 10 * x; }));
}

// The picture has one pixel, whose ray runs from `eye` to `center`.
Scene ray_scene(const glm::dvec3& eye, const glm::dvec3& center) {
    Scene scene = diagonal_scene(of_labels());
    scene.camera->eye = eye;
    scene.camera->center = center;
    scene.camera->up = {0, 0, 1};
    return scene;
}

TEST_P(NearestLookup, DepthsOfVoxelsAddUpAlongAnAxis) {
    const Scene scene = ray_scene({-9, .8, .3}, {0, .8, .3});
    const double cells = .5 + 2 + 0 + .25;            // a voxel each
    const double nodes = .5 * .5 + 2 + 0 + .5 * .25;  // half a voxel at both ends
    EXPECT_NEAR(draw(labels_along_x(Centering::cell), scene).rgba[3], -std::expm1(-cells), 1e-6);
    EXPECT_NEAR(draw(labels_along_x(Centering::node), scene).rgba[3], -std::expm1(-nodes), 1e-6);
}

// The ray enters at x = -.5, y = .25 and rises by 1/2 a voxel each: it stays in the box until x =
// 3.5, y = 2.25, and crosses four columns of labels, each over a length of sqrt(1.25).
TEST_P(NearestLookup, DepthsOfVoxelsAddUpAlongAnObliqueRay) {
    const Scene scene = ray_scene({-4.5, -1.75, .3}, {-.5, .25, .3});
    const double depth = std::sqrt(1.25) * (.5 + 2 + 0 + .25);
    EXPECT_NEAR(draw(labels_along_x(Centering::cell), scene).rgba[3], -std::expm1(-depth), 1e-6);
}

template <typename Sample>
Volume voxels_of_noise(std::array<std::int64_t, 3> size, Centering centering, double largest) {
    return as_voxels(noise<Sample>(size, centering, largest));
}

TEST_P(NearestLookup, NoiseMeetsTheTracerWithAnyNumberOfSlabs) {
    for (const Volume& volume : {voxels_of_noise<std::uint8_t>({13, 9, 11}, Centering::cell, 255),
                                 voxels_of_noise<std::uint16_t>({9, 8, 7}, Centering::node, 65535),
                                 voxels_of_noise<std::int16_t>({5, 9, 12}, Centering::cell, 3000),
                                 voxels_of_noise<float>({6, 9, 11}, Centering::node, 1e-3)}) {
        for_each_exact_scene(volume, [&](Scene& scene, const std::string& name) {
            const Image reference = trace(volume, scene, 1e-8);
            for (const int slabs : {1, 7, 512}) {
                scene.slice.samples = slabs;
                EXPECT_LE(linf(draw(volume, scene), reference), promised) << name << " " << slabs;
            }
        });
    }
}

TEST_P(NearestLookup, ThinVolumesMeetTheTracer) {
    for (const std::array<std::int64_t, 3> size :
         {std::array<std::int64_t, 3>{1, 9, 12}, {7, 1, 8}, {6, 9, 1}, {2, 2, 40}, {1, 1, 1}}) {
        const auto volume = voxels_of_noise<std::uint8_t>(size, Centering::cell, 255);
        Scene scene = exact_scene(many_points(0, 255, .5), Projection::perspective);
        lamina::look_from(volume, glm::dvec3(.5, .8, -.6), 1.1, scene);
        EXPECT_LE(linf(draw(volume, scene), trace(volume, scene, 1e-8)), promised)
            << size[0] << " " << size[1] << " " << size[2];
    }
}

// As many labels as codes of 16 bits name, each in a voxel of its own.
TEST_P(NearestLookup, EachOfManyLabelsHasItsOwnOptics) {
    constexpr int labels = 65535, edge = 41;
    const Volume volume = as_voxels(test::volume_of<std::uint16_t>(
        test::grid_of({edge, edge, edge}, Centering::cell), [](double x, double y, double z) {
            return std::fmod(40503 * (x + edge * (y + edge * z)), labels);
        }));
    std::vector<TransferKnot> points;
    for (int label = 0; label < labels; ++label) {
        const auto share = [&](int of) { return label % of / double(of); };
        points.push_back(knot(label, {share(7), share(11), share(13)}, share(5) / 4));
    }
    Scene scene = exact_scene(TransferFunction::nearest(points), Projection::perspective);
    lamina::look_from(volume, glm::dvec3(.6, .5, .8), 1.1, scene);
    EXPECT_LE(linf(draw(volume, scene), trace(volume, scene, 1e-8)), promised);
}

// A voxel whose sample is NaN is transparent, and no other.
TEST_P(NearestLookup, OnlyVoxelsOfNanShowNothing) {
    const Volume volume = as_voxels(
        test::volume_of<float>(test::grid_of({4, 3, 2}, Centering::cell),
                               [](double x, double, double) { return x == 1 ? NAN : 10 * x; }));
    Scene scene = ray_scene({-9, .8, .3}, {0, .8, .3});
    scene.nan = NanPolicy::transparent;
    EXPECT_NEAR(draw(volume, scene).rgba[3], -std::expm1(-(.5 + 0 + .25)), 1e-6);
}

// Empty regions are leapt over, and bricks share a layer of samples, whose voxels one of them has.
TEST_P(NearestLookup, BricksAndEmptyRegionsMeetTheTracer) {
    const Volume volume = as_voxels(test::volume_of<std::uint8_t>(
        test::grid_of({40, 33, 26}, Centering::cell), [](double x, double y, double z) {
            const bool inside = std::hypot(x - 25, y - 12, z - 20) < 7 || (x > 37 && y > 30);
            return inside ? 100 + std::fmod(7 * x + 5 * y + 3 * z, 20) : 0;
        }));
    Scene scene = exact_scene(
        TransferFunction::linear({knot(50, {1, .5, .2}, 0), knot(120, {.2, .9, .5}, .4)}),
        Projection::perspective);
    lamina::look_from(volume, glm::dvec3(.6, .5, .8), 1.1, scene);
    const Image reference = trace(volume, scene, 1e-8);
    Capabilities small = capabilities();
    small.max_3d_texture_size = 9;
    EXPECT_LE(linf(draw(volume, scene), reference), promised);
    EXPECT_LE(linf(draw(volume, scene, {}, small), reference), promised);
    EXPECT_LE(linf(draw(volume, scene, leave_nothing_out()), reference), promised);
    if (is_native()) {
        EXPECT_LE(linf(draw(test::stored(volume), scene), reference), promised);
    }
}

// The copy of the samples knows if its cells are voxels.
TEST(CpuVolume, IsNotReusedForAnotherLookup) {
    const Volume volume = labels_along_x(Centering::cell);
    SlicePlan plan;
    plan.bricks = {TextureBrick{{0, 0, 0}, volume.grid().size}};
    plan.nearest = true;
    const CpuVolume voxels(volume, {0, 32}, plan);
    EXPECT_TRUE(voxels.can_replace(volume, {0, 32}, plan));
    plan.nearest = false;
    EXPECT_FALSE(voxels.can_replace(volume, {0, 32}, plan));
}

}  // namespace
}  // namespace lamina
