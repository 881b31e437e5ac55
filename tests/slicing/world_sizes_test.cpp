// SPDX-License-Identifier: Apache-2.0
// Worlds as small as atoms and as large as galaxies give the same picture as a world of size 1.
#include "cpu_fixture.h"
#include "support/volume_of.h"

namespace lamina {
namespace {

struct World {
    Volume volume;
    Scene scene;
};

// Returns a world `size` times as large, with the same opacities.
World resized(const World& world, double size) {
    Grid grid = world.volume.grid();
    grid.origin *= size;
    for (glm::dvec3& step : grid.step) step *= size;
    const std::shared_ptr<const void> samples(world.volume.data(), [](const void*) {});
    Scene scene = world.scene;
    scene.transfer_function = scene.transfer_function->attenuated(1 / size);
    scene.camera->eye *= size;
    scene.camera->center *= size;
    scene.camera->height *= size;
    return {Volume(grid, world.volume.type(), samples), scene};
}

enum class Place { outside, inside };

World world_of(Projection projection, Place place, Classification classification) {
    World world{gaussians(20), unit_box_scene(smooth_transfer_function(), projection, 40, 30)};
    if (place == Place::inside) {
        world.scene.camera->eye = {.3, .45, .6};
        world.scene.camera->fov_y = 90;
    }
    world.scene.slice.classification = classification;
    world.scene.slice.samples = 150;
    return world;
}

std::vector<World> worlds() {
    std::vector<World> all;
    for (const auto way : {Classification::post, Classification::preintegrated}) {
        for (const auto projection : {Projection::perspective, Projection::orthographic})
            all.push_back(world_of(projection, Place::outside, way));
        all.push_back(world_of(Projection::perspective, Place::inside, way));
    }
    return all;
}

// Multiplying by powers of two changes no digit.
constexpr std::array exponents{-300, -110, 70, 300};

TEST(CpuWorldSizes, PowersOfTwoChangeNoBit) {
    for (const World& world : worlds()) {
        const Image picture = render_tiles(world.volume, world.scene);
        World coded = world;
        coded.scene.target = Target::emulated;
        coded.scene.slice.dither = DitherSettings{.period = 7};
        const Image codes = render_tiles(coded.volume, coded.scene);
        for (const int exponent : exponents) {
            const World other = resized(world, std::ldexp(1., exponent));
            EXPECT_EQ(render_tiles(other.volume, other.scene).rgba, picture.rgba) << exponent;
            const World other_coded = resized(coded, std::ldexp(1., exponent));
            EXPECT_EQ(render_tiles(other_coded.volume, other_coded.scene).rgba, codes.rgba)
                << exponent;
        }
    }
}

TEST_F(SlicingTest, ScalingTheWorldByPowersOfTwoChangesNoBit) {
    for (const World& world : worlds()) {
        const Image picture = render(world.volume, world.scene, capabilities());
        for (const int exponent : exponents) {
            const World other = resized(world, std::ldexp(1., exponent));
            EXPECT_EQ(render(other.volume, other.scene, capabilities()).rgba, picture.rgba)
                << exponent;
        }
    }
}

// Sizes that are not powers of two round coordinates once, by some 1e-16, far less than the
// picture's error. The tracer does not scale by units.
TEST(CpuWorldSizes, EverySizeMatchesTheTracer) {
    for (const World& world : worlds()) {
        const Image reference = trace(world.volume, world.scene, 1e-6);
        const double error =
            image_error(render_tiles(world.volume, world.scene), reference).all.linf;
        for (const double size : {1e-90, 1e-31, 3e20, 1e21, 1e90}) {
            const World other = resized(world, size);
            const Image picture = render_tiles(other.volume, other.scene);
            const Image traced = trace(other.volume, other.scene, 1e-6);
            // Both within their own 1e-6 of full scale, and roundings of float32.
            EXPECT_LE(image_error(traced, reference).all.linf, 255 * 2e-6) << size;
            EXPECT_LE(image_error(picture, traced).all.linf, error + 255 * 1e-5) << size;
        }
    }
}

// Extinctions that are subnormal in float32, between visible ones and alone, show nothing. Their
// inverse is infinite: no number may come of it.
TEST(CpuWorldSizes, SubnormalExtinctionsShowNothing) {
    for (const double visible : {0., 3.}) {
        World world =
            world_of(Projection::perspective, Place::outside, Classification::preintegrated);
        const auto drawn = [&](double extinction) {
            world.scene.transfer_function = TransferFunction::linear(
                {knot(.2, {.9, .2, .1}, extinction), knot(.3, {.3, .8, .2}, extinction),
                 knot(.5, {.1, .2, .9}, visible), knot(.6, {.7, .1, .4}, extinction),
                 knot(.8, {.5, .5, .1}, extinction)});
            return render_tiles(world.volume, world.scene);
        };
        const Image nothing = drawn(0);
        for (const double extinction : {1e-45, 1e-41, 9e-41, 1.1e-38})
            // Float32 rounds by some 1e-4 / 255 if the table has entries beside the visible ones.
            EXPECT_LE(linf(drawn(extinction), nothing), 1e-3) << extinction << " " << visible;
    }
}

}  // namespace
}  // namespace lamina
