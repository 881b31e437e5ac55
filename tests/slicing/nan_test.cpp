// SPDX-License-Identifier: Apache-2.0
// Random patterns of NaN: the cells with a NaN corner are transparent, and no others.
#include "cpu_fixture.h"
#include "simd/instruction_set.h"
#include "support/volume_of.h"

namespace lamina {
namespace {

constexpr double most_extinction = .5;

// Returns a volume of up to 5 samples on each axis, `cell` or `node`, some of them NaN or infinite.
Volume with_gaps(std::mt19937& random) {
    Grid grid;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        grid.size[axis] = static_cast<std::int64_t>(1 + random() % 5);
        grid.centering[axis] = random() % 4 > 0 ? Centering::cell : Centering::node;
    }
    std::uniform_real_distribution<float> value(0, 1);
    const float gap = random() % 2 > 0 ? NAN : INFINITY;
    const auto every = 3 + random() % 10;
    std::int64_t left = grid.sample_count();
    return test::volume_of<float>(grid, [&](double, double, double) {
        const bool last_chance = --left == 0;  // a volume of nothing but gaps would be refused
        return random() % every == 0 && !last_chance ? gap : value(random);
    });
}

Scene scene_of(const Volume& volume, std::mt19937& random) {
    std::normal_distribution<double> direction;
    Scene scene;
    scene.slice.classification = Classification::post;
    scene.transfer_function =
        TransferFunction::linear({knot(0, {1, .2, 0}, .1), knot(1, {0, .4, 1}, most_extinction)});
    scene.camera = reference_test::camera_at(
        volume.grid(), random() % 2 > 0 ? Projection::perspective : Projection::orthographic,
        {direction(random), direction(random), direction(random)}, 1.2);
    scene.camera->fov_y = 45;
    scene.width = 24;
    scene.height = 18;
    scene.nan = NanPolicy::transparent;
    return scene;
}

// Returns the largest error in 1/255. A segment across the border of a transparent cell may be
// completely wrong; a ray crosses at most 6 planes of samples on each axis. Elsewhere the scalar
// changes by at most sqrt(3) per voxel: so it differs from that in the segment's middle by at most
// half a segment's change, and on average by half of that.
double bound(const Volume& volume, const Scene& scene, int slabs) {
    const double slope = std::sqrt(3.);
    const double longest = reference_test::diagonal_of(volume.grid());
    const Facts facts = measure(scene, volume, measure_bricks(volume));
    const double segment = longest / slabs * facts.max_length_per_depth;
    const double borders = 18 * segment * most_extinction;
    const double depths = longest * most_extinction * slope * segment / 4;
    const double colors = slope * segment / 2;
    const double roundings = 1e-4;
    return 255 * (borders + depths + colors + roundings);
}

void expect_within(double most, const Image& picture, const Image& reference) {
    EXPECT_LE(image_error(picture, reference).all.linf, most);
}

Capabilities with_bricks(Capabilities capabilities) {
    capabilities.max_3d_texture_size = 3;
    return capabilities;
}

TEST(CpuNanTest, EveryPatternMatchesTheTracer) {
    constexpr int slabs = 4000;
    std::mt19937 random(5);
    for (int pattern = 0; pattern < 20; ++pattern) {
        const Volume volume = with_gaps(random);
        Scene scene = scene_of(volume, random);
        scene.slice.samples = slabs;
        const Image reference = trace(volume, scene, 1e-6);
        const double most = bound(volume, scene, slabs);
        for (const auto way : {Classification::post, Classification::preintegrated}) {
            scene.slice.classification = way;
            SCOPED_TRACE(fmt::format("pattern {}, {}", pattern, name_of(way)));
            const Capabilities all = cpu_capabilities();
            expect_within(most, render_tiles(volume, scene), reference);
            expect_within(most, render_tiles(volume, scene, leave_nothing_out()), reference);
            expect_within(most, render_tiles(volume, scene, {}, with_bricks(all)), reference);
            Scene codes = scene;  // in double precision; a slab has three roundings to codes
            codes.target = Target::emulated;
            codes.emulate = {16, AlphaRounding::nearest, OverRounding::fused, 1};
            codes.slice.samples = slabs / 4;
            expect_within(4 * most + 1.5 * 255 * (slabs / 4.) / 65535, render_tiles(volume, codes),
                          reference);
        }
    }
}

TEST(CpuNanTest, EveryInstructionSetGivesTheSameBits) {
    std::mt19937 random(6);
    for (int pattern = 0; pattern < 4; ++pattern) {
        const Volume volume = with_gaps(random);
        Scene scene = scene_of(volume, random);
        scene.slice.samples = 100;
        const Image first = render_tiles(volume, scene);
        for (const std::string& name : instruction_sets()) {
            restrict_instructions(name);
            EXPECT_EQ(render_tiles(volume, scene).rgba, first.rgba) << name;
        }
        restrict_instructions(instruction_sets().front());
    }
}

TEST_F(SlicingTest, EveryPatternOfNanMatchesTheTracer) {
    constexpr int slabs = 3000;
    std::mt19937 random(7);
    for (int pattern = 0; pattern < 8; ++pattern) {
        const Volume volume = with_gaps(random);
        Scene scene = scene_of(volume, random);
        scene.slice.samples = slabs;
        const Image reference = trace(volume, scene, 1e-6);
        const double most = bound(volume, scene, slabs);
        scene.slice.classification =
            pattern % 2 > 0 ? Classification::preintegrated : Classification::post;
        SCOPED_TRACE(pattern);
        Capabilities fetching = capabilities();
        fetching.exact_float_filter = false;
        expect_within(most, render(volume, scene, capabilities()), reference);
        expect_within(most, render(volume, scene, fetching), reference);
        expect_within(most, render(volume, scene, with_bricks(capabilities())), reference);
    }
}

}  // namespace
}  // namespace lamina
