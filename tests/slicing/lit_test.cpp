// SPDX-License-Identifier: Apache-2.0
// Lit exact segments (docs/numerics.md, section 10) against a closed form and the reference tracer.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "reference/lit_fixtures.h"
#include "support/expect_error.h"
#include "support/volume_of.h"
#include "tile_fixture.h"

namespace lamina {
namespace {

using reference_test::directional;
using reference_test::lit_by_one_gradient;

// Sums of a few hundred roundings of float32 at full scale, and those of half-precision gradients,
// 5e-4, of which a direction and a length have a third.
constexpr double float_error = .05;

double linf(const Image& a, const Image& b) {
    return image_error(a, b).all.linf;
}

template <typename Sample>
Volume noise(const Grid& grid, double largest) {
    std::uint32_t state = 12345;
    return test::volume_of<Sample>(grid, [&](double, double, double) {
        state = state * 1664525u + 1013904223u;
        return largest * (state >> 8) / 0x1p24;
    });
}

// Gradients of every size, of a few waves.
template <typename Sample>
Volume waves(const Grid& grid, double largest) {
    return test::volume_of<Sample>(grid, [&](double x, double y, double z) {
        return largest * (.5 + .5 * std::sin(.5 * x + .3 * y * std::sin(.2 * z)));
    });
}

TransferFunction colors_of(const Volume& volume, double depth) {
    const ValueRange range = measure_bricks(volume).whole;
    const Grid& grid = volume.grid();
    const double extinction =
        depth / glm::length(grid.to_world(grid.index_max()) - grid.to_world(grid.index_min()));
    const double width = range.hi > range.lo ? range.hi - range.lo : 1;
    const auto at = [&](double share) { return range.lo + share * width; };
    return TransferFunction::linear(
        {knot(at(.1), {.9, .2, .1}, 0), knot(at(.4), {.3, .9, .2}, .4 * extinction),
         knot(at(.6), {1, .8, .7}, 3 * extinction), knot(at(1), {.1, .3, 1}, extinction)});
}

Scene lit_scene(const Volume& volume, double depth, Lighting lighting, double smallest_share) {
    Scene scene = unit_box_scene(colors_of(volume, depth), Projection::perspective, 60, 45);
    scene.slice.classification = Classification::automatic;
    const ValueRange range = measure_bricks(volume).whole;
    double step = 1e300;
    for (const glm::dvec3& each : volume.grid().step) step = std::min(step, glm::length(each));
    const double width = range.hi > range.lo ? range.hi - range.lo : 1;
    lighting.smallest_gradient = smallest_share * width / step;
    scene.lighting = lighting;
    return scene;
}

void look_from(const Volume& volume, const glm::dvec3& direction, double distance, Scene& scene) {
    const Grid& grid = volume.grid();
    const double diagonal = reference_test::diagonal_of(grid);
    scene.camera.center = reference_test::middle_of(grid);
    scene.camera.eye = scene.camera.center + distance * diagonal * glm::normalize(direction);
    scene.camera.height = .8 * diagonal;
}

Image traced(const Volume& volume, const Scene& scene) {
    return to_float(trace_volume(volume, scene.transfer_function,
                                 View(scene.camera, scene.width, scene.height),
                                 {1e-6, scene.lighting})
                        .image);
}

std::vector<Lighting> lightings() {
    Lighting shiny = directional();
    shiny.power = 64;
    Lighting odd;
    odd.power = 7.5;
    odd.lights.push_back({glm::dvec3(1, .2, .3), {.2, .4, .6}});
    Lighting matt;
    matt.specular = 0;
    return {Lighting{}, shiny, odd, matt};
}

void keeps_max_error(const Volume& volume, double smallest_share) {
    for (const Lighting& lighting : lightings()) {
        Scene scene = lit_scene(volume, 5, lighting, smallest_share);
        for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
            scene.camera.projection = projection;
            look_from(volume, {.4, -.7, .9}, projection == Projection::perspective ? .4 : 1, scene);
            const Image reference = traced(volume, scene);
            for (const double max_error : {1., 4.}) {
                scene.max_error = max_error;
                EXPECT_LE(linf(render_tiles(volume, scene), reference), max_error)
                    << name_of(projection) << ", power " << lighting.power;
            }
        }
    }
}

Grid turned(const std::array<std::int64_t, 3>& size, Centering centering) {
    Grid grid = test::grid_of(size, centering);
    grid.origin = {3, -5, 7};
    grid.step = {glm::dvec3(2, 1, 2) * .25, glm::dvec3(-2, 2, 1) * .5, glm::dvec3(1, 2, -2) * .3};
    return grid;
}

TEST(LitTest, SmoothFieldsKeepMaxError) {
    keeps_max_error(waves<std::uint8_t>(test::grid_of({17, 13, 15}, Centering::cell), 255), .01);
    keeps_max_error(waves<float>(turned({13, 17, 11}, Centering::node), 1e-3), .01);
    keeps_max_error(waves<std::int16_t>(turned({11, 9, 13}, Centering::cell), 3000), .003);
}

TEST(LitTest, NoiseKeepsMaxError) {
    keeps_max_error(noise<std::uint8_t>(test::grid_of({13, 9, 11}, Centering::cell), 255), .01);
    keeps_max_error(noise<std::uint16_t>(turned({9, 8, 11}, Centering::node), 65535), .05);
}

TEST(LitTest, ThinVolumesKeepMaxError) {
    for (const std::array<std::int64_t, 3> size :
         {std::array<std::int64_t, 3>{1, 9, 12}, {7, 1, 8}, {6, 9, 1}, {2, 2, 14}, {1, 1, 1}})
        keeps_max_error(waves<float>(test::grid_of(size, Centering::cell), 1), .01);
}

// Samples are exact, and so are their differences. All rays are parallel.
TEST(LitTest, ALinearFieldIsTheUnlitPictureTimesAConstant) {
    const Grid grid = turned({8, 6, 7}, Centering::cell);
    const glm::dvec3 gradient(.25, -.125, .5);
    const Volume volume = test::volume_of<float>(grid, [&](double x, double y, double z) {
        return glm::dot(gradient, grid.to_world({x, y, z}));
    });
    Scene scene = lit_scene(volume, 3, directional(), .05);
    scene.camera.projection = Projection::orthographic;
    look_from(volume, {.4, -.7, .9}, 1, scene);
    Scene unlit = scene;
    unlit.lighting.reset();
    const Image lit = render_tiles(volume, scene), plain = render_tiles(volume, unlit);
    for (int row = 0; row < scene.height; ++row) {
        for (int column = 0; column < scene.width; ++column) {
            const float *const a = plain.pixel(column, row), *const b = lit.pixel(column, row);
            const glm::dvec3 expected =
                lit_by_one_gradient({a[0], a[1], a[2]}, a[3], gradient, *scene.lighting,
                                    scene.camera.center - scene.camera.eye);
            ASSERT_EQ(b[3], a[3]);
            for (int c = 0; c < 3; ++c) ASSERT_NEAR(b[c], expected[c], 2 * float_error / 255);
        }
    }
}

TEST(LitTest, AmbientAloneIsTheUnlitPicture) {
    const Volume volume = noise<float>(test::grid_of({9, 8, 7}, Centering::node), 1);
    Scene scene = lit_scene(volume, 5, reference_test::ambient_alone(), .01);
    look_from(volume, {.4, -.7, .9}, .6, scene);
    const Image lit = render_tiles(volume, scene);
    scene.lighting.reset();
    EXPECT_LE(linf(lit, render_tiles(volume, scene)), float_error);
}

// Neighbours of what is no number have one-sided gradients, and their other cells are seen.
TEST(LitTest, WhatIsNoNumberIsTransparent) {
    std::uint32_t state = 7;
    const Volume volume = test::volume_of<float>(
        test::grid_of({9, 8, 7}, Centering::cell), [&](double x, double, double) {
            state = state * 1664525u + 1013904223u;
            return state % 13 == 0 ? NAN : std::sin(.7 * x) + (state >> 8) / 0x1p25;
        });
    Scene scene = lit_scene(volume, 5, Lighting{}, .01);
    scene.nan = NanPolicy::transparent;
    look_from(volume, {.4, -.7, .9}, .6, scene);
    EXPECT_LE(linf(render_tiles(volume, scene), traced(volume, scene)), 1);
}

// The slabs of a tree's leaves are lit as a whole ray is.
TEST(LitTest, TreesKeepTheColours) {
    const Volume volume = waves<float>(test::grid_of({9, 8, 7}, Centering::node), 1);
    Scene scene = lit_scene(volume, 5, directional(), .01);
    look_from(volume, {.4, -.7, .9}, .6, scene);
    scene.slice.tree = TreeSettings{.factors = {4, 8}};
    EXPECT_LE(linf(render_tiles(volume, scene), traced(volume, scene)), 1);
}

TEST(LitTest, ThePlanLeavesOutWhatLightDoesNotNeed) {
    const Volume volume =
        test::volume_of<float>(test::grid_of({20, 20, 20}, Centering::node),
                               [](double x, double, double) { return x < 10 ? 0 : 1; });
    Scene scene =
        unit_box_scene(TransferFunction::linear({knot(0, {1, 1, 1}, .1), knot(1, {1, 1, 1}, 2)}),
                       Projection::perspective);
    scene.slice.classification = Classification::exact;
    const auto plan_of = [&](const Scene& each) {
        return make_plan(each, measure(each, volume, measure_bricks(volume)), tile_capabilities(),
                         {});
    };
    const auto leaves_out = [](const Plan& plan, const std::string& name) {
        return std::ranges::find(plan.omitted, name, &Omission::name) != plan.omitted.end();
    };
    for (const char* const name : {"color", "constant_regions"})
        EXPECT_TRUE(leaves_out(plan_of(scene), name)) << name;
    scene.lighting = directional();
    const Plan plan = plan_of(scene);
    for (const char* const name : {"color", "constant_regions"})
        EXPECT_FALSE(leaves_out(plan, name)) << name;
    EXPECT_TRUE(leaves_out(plan, "blending"));
    const Facts facts = measure(scene, volume, measure_bricks(volume));
    EXPECT_NE(explain(plan, facts, tile_capabilities()).find("light"), std::string::npos);
}

TEST(LitTest, WhatCannotBeDrawnLitIsRefused) {
    const Volume volume = waves<float>(test::grid_of({5, 5, 5}, Centering::node), 1);
    Scene scene = lit_scene(volume, 5, Lighting{}, .01);
    Capabilities other = tile_capabilities();
    other.tiles = false;
    expect_error([&] { render_tiles(volume, scene, {}, other); }, {"lighting", "--context cpu"});
    scene.lighting->smallest_gradient.reset();
    expect_error([&] { render_tiles(volume, scene); }, {"lighting.smallest_gradient"});
}

}  // namespace
}  // namespace lamina
