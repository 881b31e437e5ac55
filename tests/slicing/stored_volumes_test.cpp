// SPDX-License-Identifier: Apache-2.0
// Pictures of volumes that stay on disk are equal, bit for bit, to those of the same volumes in
// memory.
#include <gtest/gtest.h>

#include <limits>

#include "cpu_fixture.h"
#include "exact_fixture.h"
#include "slicing/cpu_volume.h"
#include "support/expect_error.h"
#include "support/stored_volume.h"

namespace lamina {
namespace {

// Returns a renderer that draws `drawn`; min/max bricks are measured in the volume in memory.
std::unique_ptr<CpuSliceRenderer> renderer_of(const Volume& drawn, const Volume& in_memory,
                                              const Scene& scene,
                                              const Capabilities& capabilities) {
    const Facts facts = measure(scene, drawn, measure_bricks(in_memory));
    const Plan plan = make_plan(scene, facts, capabilities, {});
    return std::make_unique<CpuSliceRenderer>(drawn, *scene.transfer_function, facts, plan.slice,
                                              scene.width, scene.height);
}

Image draw(CpuSliceRenderer& renderer, const Scene& scene) {
    renderer.draw(View(*scene.camera, scene.width, scene.height));
    return renderer.read();
}

void expect_same(const Volume& volume, const Scene& scene, const char* what,
                 const Capabilities& capabilities = cpu_capabilities()) {
    const auto in_memory = renderer_of(volume, volume, scene, capabilities);
    const Image expected = draw(*in_memory, scene);
    const auto in_files = renderer_of(test::stored(volume), volume, scene, capabilities);
    EXPECT_EQ(draw(*in_files, scene).rgba, expected.rgba) << what;
    if (!in_files->volume()) return;  // a constant volume: no sample is read
    ASSERT_NE(in_files->volume()->pages(), nullptr) << what;
    in_files->volume()->pages()->clear();
    in_files->volume()->pages()->set_capacity(0);
    EXPECT_EQ(draw(*in_files, scene).rgba, expected.rgba) << what << ", in little memory";
}

Scene scene_of(const Volume& volume, Classification classification,
               const glm::dvec3& direction = {3, 2, 1}) {
    const bool constant = measure_bricks(volume).whole.lo == measure_bricks(volume).whole.hi;
    Scene scene =
        unit_box_scene(constant ? many_points(0, 256, .1) : in_view_of(volume, 20, many_points),
                       Projection::perspective, 60, 45);
    scene.slice.classification = classification;
    look_from(volume, direction, 1.2, scene);
    return scene;
}

// A size in samples, in which bricks of the cache (32 cells) at the far ends are cut off on x and
// y.
constexpr std::array<std::int64_t, 3> some_size{75, 40, 33};

template <typename Sample>
void expect_same_in_all_ways(double largest) {
    for (const Centering centering : {Centering::node, Centering::cell}) {
        const Volume volume = noise<Sample>(some_size, centering, largest);
        expect_same(volume, scene_of(volume, Classification::exact), "exact");
        Scene slabs = scene_of(volume, Classification::post);
        slabs.slice.samples = 70;
        expect_same(volume, slabs, "post");
        slabs.slice.classification = Classification::preintegrated;
        slabs.camera->projection = Projection::orthographic;
        expect_same(volume, slabs, "preintegrated");
        slabs.slice.filter = Filter::hardware;
        expect_same(volume, slabs, "hardware filter");
    }
}

TEST(StoredVolumes, DrawBytesAsFromMemory) {
    expect_same_in_all_ways<std::uint8_t>(255);
}
TEST(StoredVolumes, DrawSignedNumbersAsFromMemory) {
    expect_same_in_all_ways<std::int16_t>(-30000);
}
TEST(StoredVolumes, DrawWordsAsFromMemory) {
    expect_same_in_all_ways<std::uint16_t>(65535);
}
TEST(StoredVolumes, DrawFloatsAsFromMemory) {
    expect_same_in_all_ways<float>(1e-3);
}

TEST(StoredVolumes, DrawMoreBricksThanFitAsFromMemory) {
    const Volume volume = noise<std::uint8_t>({400, 300, 130}, Centering::node, 255);
    ASSERT_GT(volume.byte_count(), std::size_t{1} << 23);
    expect_same(volume, scene_of(volume, Classification::exact), "exact");
    Scene inside = scene_of(volume, Classification::exact);
    inside.camera->eye = inside.camera->center + glm::dvec3(1, 2, 3);
    inside.camera->center += glm::dvec3(30, 20, 10);
    inside.camera->fov_y = 100;
    expect_same(volume, inside, "eye inside");
}

TEST(StoredVolumes, DrawThinVolumesAsFromMemory) {
    for (const std::array<std::int64_t, 3>& size : {std::array<std::int64_t, 3>{1, 40, 70},
                                                    {40, 1, 33},
                                                    {34, 65, 1},
                                                    {2, 3, 2},
                                                    {1, 1, 1},
                                                    {33, 2, 1}}) {
        const Volume bytes = noise<std::uint8_t>(size, Centering::cell, 255);
        const Volume floats = noise<float>(size, Centering::cell, 1);
        for (const Volume& volume : {bytes, floats}) {
            expect_same(volume, scene_of(volume, Classification::exact), "exact");
            Scene slabs = scene_of(volume, Classification::post);
            slabs.slice.samples = 20;
            expect_same(volume, slabs, "post");
        }
    }
}

TEST(StoredVolumes, DrawNanAsFromMemory) {
    for (const Centering centering : {Centering::node, Centering::cell}) {
        const Volume volume = test::volume_of<float>(
            test::grid_of(some_size, centering), [](double x, double y, double z) {
                return x > 20 && x < 30 && y < 9 ? std::numeric_limits<double>::quiet_NaN()
                                                 : std::sin(x * y / 40) + z / 50;
            });
        Scene scene = scene_of(volume, Classification::exact);
        scene.nan = NanPolicy::transparent;
        expect_same(volume, scene, "exact");
        scene.slice.classification = Classification::post;
        scene.slice.samples = 80;
        expect_same(volume, scene, "post");
    }
}

TEST(StoredVolumes, DrawSeveralBricksAsFromMemory) {
    Capabilities capabilities = cpu_capabilities();
    capabilities.max_texture_bytes = 60 * 45 * 16;  // a picture of floats
    const Volume bytes = noise<std::uint8_t>({160, 70, 50}, Centering::node, 255);
    const Volume floats = noise<float>({80, 70, 50}, Centering::cell, 1);
    for (const Volume& volume : {bytes, floats}) {
        expect_same(volume, scene_of(volume, Classification::exact), "exact", capabilities);
        Scene slabs = scene_of(volume, Classification::post, {-1, 2, -3});
        slabs.slice.samples = 100;
        expect_same(volume, slabs, "post", capabilities);
    }
}

TEST(StoredVolumes, DrawLightAsFromMemory) {
    const Volume bytes = noise<std::uint8_t>(some_size, Centering::node, 255);
    const Volume floats = noise<float>(some_size, Centering::cell, 1);
    for (const Volume& volume : {bytes, floats}) {
        Scene scene = scene_of(volume, Classification::exact);
        scene.lighting = Lighting{};
        (*scene.lighting)->smallest_gradient = .1;
        expect_same(volume, scene, "exact");
        scene.slice.classification = Classification::post;
        scene.slice.samples = 80;
        expect_same(volume, scene, "post");
    }
}

TEST(StoredVolumes, DrawFixedPointTreesAsFromMemory) {
    const Volume volume = noise<std::uint8_t>(some_size, Centering::node, 255);
    Scene scene = scene_of(volume, Classification::post);
    scene.slice.samples = 64;
    scene.target = Target::fixed8;
    expect_same(volume, scene, "blended");
    scene.slice.tree = TreeSettings{.factors = {8, 8}};
    expect_same(volume, scene, "tree");
}

// Pages that show nothing are not read, and pages in memory are not read again.
TEST(StoredVolumes, ReadOnlyVisiblePagesAndThoseOnce) {
    const Volume volume = test::volume_of<std::uint8_t>(
        test::grid_of({256, 128, 128}, Centering::node),
        [](double x, double y, double z) { return x > 200 && y > 100 && z < 20 ? 200 : 0; });
    auto source = std::make_unique<test::SourceInMemory>(volume);
    const test::SourceInMemory& reads = *source;
    const Volume in_files(
        volume.grid(), volume.type(),
        std::make_shared<const VolumeStore>(volume.grid(), volume.type(), std::move(source)));
    Scene scene = scene_of(volume, Classification::exact);
    scene.transfer_function =
        TransferFunction::linear({knot(100, {1, 1, 1}, 0), knot(200, {1, 1, 1}, .1)});
    in_files.store().bricks().expect({});
    const auto renderer = renderer_of(in_files, volume, scene, cpu_capabilities());
    draw(*renderer, scene);
    EXPECT_GT(reads.samples_read, 0);
    // Two pages on x and one on y and z, and the neighbours that share their last samples.
    EXPECT_LE(reads.samples_read, 3 * 2 * 2 * BrickCache::sample_count);
    reads.samples_read = 0;
    scene.camera->eye += glm::dvec3(1, 2, 3);
    draw(*renderer, scene);
    EXPECT_EQ(reads.samples_read, 0);
}

TEST(StoredVolumes, AViewFindsThePagesThatItSees) {
    const Volume volume = noise<std::uint8_t>({200, 200, 200}, Centering::node, 255);
    Scene scene = scene_of(volume, Classification::exact);
    const auto renderer = renderer_of(test::stored(volume), volume, scene, cpu_capabilities());
    const BrickCache& cache = *renderer->volume()->pages();
    std::vector<std::uint32_t> all(cache.brick_count());
    for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
    const auto seen = [&] {
        return pages_seen(all, cache.count(), {0, 0, 0}, volume.grid(),
                          View(*scene.camera, scene.width, scene.height))
            .size();
    };
    EXPECT_EQ(seen(), all.size());
    scene.camera->fov_y = 1;
    EXPECT_LT(seen(), all.size() / 3);
    scene.camera->center = 2.0 * scene.camera->eye - scene.camera->center;
    EXPECT_EQ(seen(), 0u);
}

TEST(StoredVolumes, ReportFailedAndChangedReads) {
    const Volume volume = noise<std::uint8_t>(some_size, Centering::node, 255);
    auto source = std::make_unique<test::SourceInMemory>(volume);
    test::SourceInMemory& files = *source;
    const Volume in_files(
        volume.grid(), volume.type(),
        std::make_shared<const VolumeStore>(volume.grid(), volume.type(), std::move(source)));
    const Scene scene = scene_of(volume, Classification::exact);
    const auto renderer = renderer_of(in_files, volume, scene, cpu_capabilities());
    renderer->volume()->pages()->clear();
    files.before_read = [](const SampleBox&) { fail("volume.raw: truncated"); };
    expect_error([&] { draw(*renderer, scene); }, {"truncated"});
    files.before_read = {};
    files.changed = true;
    expect_error([&] { draw(*renderer, scene); }, {"changed"});
    files.changed = false;
    EXPECT_EQ(draw(*renderer, scene).rgba,
              draw(*renderer_of(volume, volume, scene, cpu_capabilities()), scene).rgba);
}

}  // namespace
}  // namespace lamina
