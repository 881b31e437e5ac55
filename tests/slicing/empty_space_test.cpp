// SPDX-License-Identifier: Apache-2.0
// Rays that leap over empty space, in the cpu engine and in OpenGL, leave the picture as it is, bit
// for bit.
#include <random>

#include "cpu_fixture.h"
#include "support/volume_of.h"

namespace lamina {
namespace {

class EmptySpaceTest : public SlicingTest {
  protected:
    // Tells whether rays leap; both engines must agree.
    bool leaps(const Volume& volume, const Scene& scene) const {
        const Facts facts = measure(scene, volume, measure_bricks(volume));
        const bool tiles = make_plan(scene, facts, cpu_capabilities(), {}).slice.occupied_only;
        EXPECT_EQ(make_plan(scene, facts, capabilities(), {}).slice.occupied_only, tiles);
        return tiles;
    }

    // Compares pictures with and without leaps. `texture_bytes`: at most so many in a brick.
    void expect_same(const Volume& volume, const Scene& scene, const std::string& what,
                     std::uint64_t texture_bytes = std::uint64_t{1} << 30) const {
        Capabilities tiles = cpu_capabilities(), gl = capabilities();
        tiles.max_texture_bytes = gl.max_texture_bytes = texture_bytes;
        EXPECT_EQ(render_tiles(volume, scene, {}, tiles).rgba,
                  render_tiles(volume, scene, keep("empty_space"), tiles).rgba)
            << what;
        EXPECT_EQ(render(volume, scene, gl).rgba,
                  render(volume, scene, gl, keep("empty_space")).rgba)
            << what;
    }

    float largest_alpha(const Volume& volume, const Scene& scene) const {
        float least = INFINITY;
        for (const Image& image :
             {render_tiles(volume, scene), render(volume, scene, capabilities())}) {
            float largest = 0;
            for (std::size_t i = 3; i < image.rgba.size(); i += 4)
                largest = std::max(largest, image.rgba[i]);
            least = std::min(least, largest);
        }
        return least;
    }
};

// Returns a volume of any size: low noise, with some lumps and single high samples.
Volume random_volume(std::mt19937& random) {
    std::array<std::int64_t, 3> size{};
    for (std::int64_t& edge : size) edge = 1 + static_cast<std::int64_t>(random() % 45);
    const auto longest = static_cast<double>(std::ranges::max(size));
    const Grid grid =
        reference_test::make_grid(size, random() % 2 == 0 ? Centering::node : Centering::cell,
                                  glm::dvec3(1 / std::max(longest - 1, 1.0)));
    std::vector<std::uint8_t> samples(static_cast<std::size_t>(grid.sample_count()));
    for (std::uint8_t& sample : samples) sample = static_cast<std::uint8_t>(random() % 60);
    for (int lump = 0; lump < 3; ++lump) {
        const std::size_t first = random() % samples.size();
        const std::size_t count = 1 + random() % 9;
        for (std::size_t i = first; i < std::min(first + count, samples.size()); ++i)
            samples[i] = static_cast<std::uint8_t>(100 + random() % 156);
    }
    samples.front() = 0;
    samples.back() = 255;
    return reference_test::make_volume(grid, samples);
}

// Returns a transfer function that shows only values above the noise: a ramp, a band between steps,
// or a palette.
TransferFunction random_transfer_function(std::mt19937& random) {
    const double from = 60 + static_cast<double>(random() % 60);
    switch (random() % 3) {
        case 0:
            return TransferFunction::linear({knot(from, {.1, .5, .9}, 0),
                                             knot(from + 40, {.9, .5, .1}, 20),
                                             knot(255, {1, 1, 1}, 50)});
        case 1:
            return TransferFunction::linear({knot(from, {1, 0, 0}, 0), knot(from, {.2, 1, .3}, 30),
                                             knot(from + 90, {1, 1, .3}, 30),
                                             knot(from + 90, {0, 0, 1}, 0)});
        default:
            return TransferFunction::nearest({knot(0, {1, 1, 1}, 0), knot(from, {1, 1, 1}, 0),
                                              knot(from + 70, {.3, 1, .1}, 25),
                                              knot(255, {.1, .2, 1}, 9)});
    }
}

// Views from outside and inside, slabs of a fraction of a cell to many cells, one brick and
// several.
TEST_F(EmptySpaceTest, IsLeaptOverInRandomScenes) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> place(-.8, 1.8);
    int leaping = 0;
    for (int trial = 0; trial < 24; ++trial) {
        const Volume volume = random_volume(random);
        Scene scene = unit_box_scene(
            random_transfer_function(random),
            trial % 3 == 0 ? Projection::orthographic : Projection::perspective, 41, 37);
        const glm::dvec3 middle = reference_test::middle_of(volume.grid());
        scene.camera->center = middle;
        scene.camera->eye = {place(random), place(random), place(random)};
        if (trial % 4 == 1) scene.camera->eye = middle + glm::dvec3(.03, .01, .02);
        scene.slice.classification =
            trial % 2 == 0 ? Classification::preintegrated : Classification::post;
        scene.slice.samples = std::array{3, 40, 150, 333}[random() % 4];
        if (trial % 8 == 7) scene.slice.tree = TreeSettings{.factors = {3, 5}};
        const std::uint64_t bytes = trial % 4 == 2 ? 16 * 41 * 37 : std::uint64_t{1} << 30;
        expect_same(volume, scene, std::to_string(trial), bytes);
        leaping += leaps(volume, scene) ? 1 : 0;
    }
    EXPECT_GE(leaping, 16);
}

// With targets of low precision, where slabs are blended one by one, the cpu engine skips slabs in
// either order.
TEST_F(EmptySpaceTest, IsLeaptOverWhereSlabsAreBlended) {
    std::mt19937 random(2);
    for (const Order order : {Order::front_to_back, Order::back_to_front}) {
        for (const Target target : {Target::float16, Target::fixed8, Target::emulated}) {
            for (int trial = 0; trial < 4; ++trial) {
                const Volume volume = random_volume(random);
                Scene scene = unit_box_scene(random_transfer_function(random),
                                             Projection::perspective, 41, 37);
                scene.target = target;
                scene.slice.order = order;
                scene.slice.samples = 120;
                EXPECT_EQ(render_tiles(volume, scene).rgba,
                          render_tiles(volume, scene, keep("empty_space")).rgba)
                    << name_of(target) << " " << name_of(order) << " " << trial;
            }
        }
    }
}

// Looks at the sample with index `place` on each axis, several pixels a voxel.
Scene one_sample_scene(double extinction, std::size_t place = 24) {
    Scene scene = unit_box_scene(
        TransferFunction::linear({knot(11, {1, 1, 1}, 0), knot(12, {1, 1, 1}, extinction)}),
        Projection::orthographic, 60, 45);
    const glm::dvec3 moved = glm::dvec3(static_cast<double>(place) / 41) - scene.camera->center;
    scene.camera->center += moved;
    scene.camera->eye += moved;
    scene.camera->height = .3;
    scene.slice.samples = 160;
    return scene;
}

Volume one_sample_volume(std::size_t place) {
    const Grid grid = reference_test::make_grid({42, 42, 42}, Centering::node, glm::dvec3(1. / 41));
    std::vector<std::uint8_t> samples(42 * 42 * 42, 10);
    samples[(place * 42 + place) * 42 + place] = 12;
    return reference_test::make_volume(grid, samples);
}

// The visible sample lies in the middle of a min/max brick; at the corner of eight, each of which
// shows a part of it; or in the last brick, which has one cell.
TEST_F(EmptySpaceTest, HoldsNoVisibleSample) {
    for (const std::size_t place : {22, 24, 41}) {
        const Volume volume = one_sample_volume(place);
        for (const auto classification : {Classification::post, Classification::preintegrated}) {
            Scene scene = one_sample_scene(300, place);
            scene.slice.classification = classification;
            ASSERT_TRUE(leaps(volume, scene));
            EXPECT_GT(largest_alpha(volume, scene), .1f) << place;
            expect_same(volume, scene, std::to_string(place));
        }
    }
}

// A sample that is nearly transparent is not empty space.
TEST_F(EmptySpaceTest, HoldsNoFaintSample) {
    const Volume volume = one_sample_volume(24);
    const Scene scene = one_sample_scene(1e-12);
    ASSERT_TRUE(leaps(volume, scene));
    EXPECT_GT(largest_alpha(volume, scene), 0);
    expect_same(volume, scene, "faint");
}

// Every brick holds a visible sample, so there is nothing to leap over.
TEST_F(EmptySpaceTest, IsNotLookedForWhereThereIsNone) {
    const Volume volume = test::volume_of<std::uint8_t>(
        test::grid_of({41, 41, 41}, Centering::node), [](double i, double j, double k) {
            const auto inside = [](double at) { return std::fmod(at, 4) == 1; };
            return inside(i) && inside(j) && inside(k) ? 12 : 10;
        });
    const Scene scene = one_sample_scene(300);
    EXPECT_FALSE(leaps(volume, scene));
    const Facts facts = measure(scene, volume, measure_bricks(volume));
    for (const Omission& omission : make_plan(scene, facts, capabilities(), {}).omitted)
        EXPECT_NE(omission.name, "empty_space");
}

// A pre-integrated segment from scalars below the visible ones to scalars above shows what lies
// between, even if NaN separates the two and no brick holds visible values. So there must be no
// leaps.
TEST_F(EmptySpaceTest, IsNotLeaptOverByPreintegratedSegmentsAcrossNan) {
    const Volume volume = test::volume_of<float>(
        reference_test::make_grid({129, 17, 17}, Centering::node, glm::dvec3(1. / 128)),
        [](double i, double, double) {
            return i > 100 ? .5f : i > 32 ? 1.f : i < 32 ? 0.f : std::nanf("");
        });
    const OpticalProperties nothing{{1, 1, 1}, 0}, something{{1, 1, 1}, 9};
    Scene scene =
        unit_box_scene(TransferFunction::linear({{.3, nothing}, {.5, something}, {.7, nothing}}),
                       Projection::orthographic);
    scene.nan = NanPolicy::transparent;
    EXPECT_TRUE(leaps(volume, scene));
    scene.slice.classification = Classification::preintegrated;
    EXPECT_FALSE(leaps(volume, scene));
}

}  // namespace
}  // namespace lamina
