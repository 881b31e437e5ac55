// SPDX-License-Identifier: Apache-2.0
// Lit slabs, post-classified and pre-integrated (docs/numerics.md, section 10), against closed
// forms and the reference tracer.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine_fixture.h"
#include "reference/lit_fixtures.h"
#include "slicing/slab_trials.h"
#include "support/volume_of.h"

namespace lamina {
namespace {

using reference_test::directional;
using reference_test::lightings;
using reference_test::lit_by_one_gradient;

constexpr Classification both[] = {Classification::post, Classification::preintegrated};

// Error, in 1/255, of sums of a few hundred roundings of float32 at full scale, of 16-bit gradients
// (3e-5), and of rays in float32 with OpenGL.
constexpr double slab_float_error = .05;

using LitSlabsOf = EngineTest;
INSTANTIATE_TEST_SUITE_P(Engines, LitSlabsOf, every_engine, engine_name);

// Returns the root mean square of the differences, in which single pixels with a kink at the end of
// a slab count little.
double mean_square(const Image& a, const Image& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.rgba.size(); ++i) {
        const double difference = double{a.rgba[i]} - b.rgba[i];
        sum += difference * difference;
    }
    return std::sqrt(sum / static_cast<double>(a.rgba.size()));
}

Grid unit_cube(std::int64_t edge) {
    Grid grid = test::grid_of({edge, edge, edge}, Centering::node);
    for (int axis = 0; axis < 3; ++axis) {
        grid.step[static_cast<std::size_t>(axis)] = glm::dvec3(0);
        grid.step[static_cast<std::size_t>(axis)][axis] = 1. / static_cast<double>(edge - 1);
    }
    return grid;
}

// Returns a volume over [0, 1] with gradients of every size.
Volume waves(std::int64_t edge) {
    const auto last = static_cast<double>(edge - 1);
    return test::volume_of<float>(unit_cube(edge), [&](double x, double y, double z) {
        const double u = x / last, v = y / last, w = z / last;
        return .5 + .5 * std::sin(5 * u + 3 * v * std::sin(4 * w));
    });
}

Scene lit_scene(Classification classification, const Lighting& lighting) {
    Scene scene = unit_box_scene(
        TransferFunction::linear({knot(.1, {.9, .2, .1}, 0), knot(.4, {.3, .9, .2}, 2),
                                  knot(.6, {1, .8, .7}, 9), knot(1, {.1, .3, 1}, 4)}),
        Projection::perspective, 60, 45);
    scene.slice.classification = classification;
    scene.lighting = lighting;
    if ((*scene.lighting)->smallest_gradient.is_automatic())
        (*scene.lighting)->smallest_gradient = .2;
    return scene;
}

// 16 times as many slabs: their error, of second order, is less than .01 of that of few slabs.
TEST_P(LitSlabsOf, ManySlabsMeetTheTracer) {
    const Volume volume = waves(12);
    for (const Classification each : both) {
        for (const Lighting& lighting : lightings()) {
            for (const Projection projection :
                 {Projection::perspective, Projection::orthographic}) {
                if (!is_native() && projection == Projection::orthographic) continue;
                Scene scene = lit_scene(each, lighting);
                scene.camera->projection = projection;
                const Image traced = trace(volume, scene, 1e-6);
                scene.slice.samples = 40;
                const double few = linf(draw(volume, scene), traced);
                scene.slice.samples = 640;
                const double many = linf(draw(volume, scene), traced);
                EXPECT_LE(many, few / 100 + slab_float_error) << name_of(each) << few;
            }
        }
    }
}

// A quadratic field has linear gradients, which differences give exactly, except at the border,
// where they are one-sided (clipped away). All lights lie on one side of all gradients, so light
// has no kinks.
TEST(LitSlabs, ErrorFallsWithTheSquareOfTheThickness) {
    const Volume volume = test::volume_of<float>(unit_cube(33), [](double x, double y, double z) {
        const glm::dvec3 from(x / 32 + 1.5, y / 32 + 1.2, z / 32 + .9);
        return glm::dot(from, from) / 15;
    });
    Lighting lighting = directional();
    lighting.lights = {{glm::dvec3(1, 1.2, .9), {1, .5, .25}}, {glm::dvec3(1, .4, .8), {0, .5, 1}}};
    lighting.power = 20;
    for (const Classification each : both) {
        Scene scene = lit_scene(each, lighting);
        scene.transfer_function =
            TransferFunction::linear({knot(0, {.9, .2, .1}, 0), knot(1.2, {.1, .9, 1}, 6)});
        scene.clip.box = ClipBox{{.05, .05, .05}, {.95, .95, .95}};
        const Image traced = trace(volume, scene, 1e-8);
        double before = 0;
        for (const int slabs : {6, 12, 24}) {
            scene.slice.samples = slabs;
            const double error = mean_square(render_tiles(volume, scene), traced);
            // The exact factor, 4, is reached in the limit of many slabs; roundings are a few 1e-6.
            if (before > 0) {
                EXPECT_GT(before / error, 3.2) << name_of(each) << " " << slabs << " " << error;
                EXPECT_LT(before / error, 5) << name_of(each) << " " << slabs << " " << error;
            }
            before = error;
        }
    }
}

// Samples are exact in binary, and so are their differences. Rays are parallel, so light is the
// same everywhere.
TEST_P(LitSlabsOf, ALinearFieldIsTheUnlitPictureTimesAConstant) {
    const Grid grid = unit_cube(9);
    const glm::dvec3 gradient(.25, -.125, .5);
    const Volume volume = test::volume_of<float>(grid, [&](double x, double y, double z) {
        return .125 + glm::dot(gradient, grid.to_world({x, y, z}));
    });
    for (const Classification each : both) {
        for (const int slabs : {7, 60}) {
            Scene scene = lit_scene(each, directional());
            scene.camera->projection = Projection::orthographic;
            scene.slice.samples = slabs;
            Scene unlit = scene;
            unlit.lighting.reset();
            const Image lit = draw(volume, scene), plain = draw(volume, unlit);
            for (std::size_t i = 0; i < lit.rgba.size(); i += 4) {
                const float *const a = &plain.rgba[i], *const b = &lit.rgba[i];
                const glm::dvec3 expected =
                    lit_by_one_gradient({a[0], a[1], a[2]}, a[3], gradient, **scene.lighting,
                                        scene.camera->center - scene.camera->eye);
                ASSERT_EQ(b[3], a[3]);
                for (int c = 0; c < 3; ++c)
                    ASSERT_NEAR(b[c], expected[c], 2 * slab_float_error / 255);
            }
        }
    }
}

TEST_P(LitSlabsOf, AmbientAloneIsTheUnlitPicture) {
    const Volume volume = waves(9);
    for (const Classification each : both) {
        Scene scene = lit_scene(each, reference_test::ambient_alone());
        scene.slice.samples = 50;
        const Image lit = draw(volume, scene);
        scene.lighting.reset();
        EXPECT_LE(linf(lit, draw(volume, scene)), slab_float_error) << name_of(each);
    }
}

TEST(LitSlabs, AmbientAloneIsTheUnlitPictureBitForBit) {
    const Volume volume = waves(9);
    for (const Classification each : both) {
        Scene scene = lit_scene(each, reference_test::ambient_alone());
        scene.slice.samples = 50;
        const Image lit = render_tiles(volume, scene);
        scene.lighting.reset();
        EXPECT_EQ(lit.rgba, render_tiles(volume, scene).rgba) << name_of(each);
    }
}

// The colour of a narrow peak inside a segment is lit as at the place of the peak, and not as in
// the segment's middle.
TEST(LitSlabs, PreintegrationKnowsWhereInASegmentColorsAre) {
    const Volume volume = waves(12);
    Scene scene = lit_scene(Classification::preintegrated, directional());
    scene.transfer_function = TransferFunction::linear(
        {knot(.5, {1, .4, .2}, 0), knot(.52, {1, .8, .3}, 60), knot(.54, {.1, .5, 1}, 0)});
    const Image traced = trace(volume, scene, 1e-6);
    scene.slice.samples = 60;
    const double preintegrated = linf(render_tiles(volume, scene), traced);
    scene.slice.classification = Classification::post;
    EXPECT_LT(preintegrated, linf(render_tiles(volume, scene), traced) / 4);
}

TEST(LitSlabs, AutomaticSamplesKeepMaxErrorAgainstTheLitTracer) {
    const Volume volume = waves(16);
    for (const Classification each : both) {
        for (const Lighting& lighting : {Lighting{}, directional()}) {
            Scene scene = lit_scene(each, lighting);
            const Image traced = trace(volume, scene, 1e-6);
            for (const double max_error : {1., 4.}) {
                scene.max_error = max_error;
                const MinMaxBricks bricks = measure_bricks(volume);
                const Facts facts = measure(scene, volume, bricks);
                TableCache tables;
                const SampleTrials trials =
                    try_samples(scene, volume, bricks, facts, cpu_capabilities(), false, tables);
                ASSERT_FALSE(trials.exact.empty());
                const Plan plan = make_plan(scene, facts, cpu_capabilities(), {}, trials);
                Scene chosen = scene;
                chosen.slice.samples = plan.slice.slabs;
                EXPECT_LE(linf(render_tiles(volume, chosen), traced), max_error)
                    << name_of(each) << " " << plan.slice.slabs;
                // The error is that of lit rays: unlit ones would need fewer slabs.
                EXPECT_GT(plan.slice.slab_trial->error, .3 * max_error);
            }
        }
    }
}

// Gradients beside NaN samples are one-sided differences.
TEST_P(LitSlabsOf, NanSamplesAreTransparent) {
    const Grid grid = unit_cube(10);
    const Volume volume = test::volume_of<float>(grid, [&](double x, double y, double z) {
        return x > 4 && y > 3 && z < 5 ? NAN : .1 + .05 * x + .02 * y + .01 * z * z;
    });
    for (const Classification each : both) {
        Scene scene = lit_scene(each, Lighting{});
        scene.nan = NanPolicy::transparent;
        const Image traced = trace(volume, scene, 1e-6);
        const auto error = [&](int slabs) {
            scene.slice.samples = slabs;
            return mean_square(draw(volume, scene), traced);
        };
        // Segments that end in NaN are left out, which is an error of first order.
        EXPECT_LE(error(1600), error(100) / 8) << name_of(each);
    }
}

// Returns a lighting under which colours stay below 1, because fixed-point targets hold no larger
// ones.
Lighting dim() {
    Lighting lighting = directional();
    lighting.specular = 0;
    lighting.diffuse = .4;
    return lighting;
}

TEST_P(LitSlabsOf, TreesAndClippedVolumesAreLit) {
    const Volume volume = waves(12);
    for (const Classification each : both) {
        Scene scene = lit_scene(each, dim());
        scene.clip.planes = {{{.5, .5, .5}, {.3, -.5, .7}}};
        scene.slice.samples = 600;
        const Image straight = draw(volume, scene);
        // 600 slabs over 11 voxels are about 1 / 50 of a voxel thick; the error is at most the
        // square of that, 1 / 2500 of full scale.
        EXPECT_LE(linf(straight, trace(volume, scene, 1e-6)), 255. / 2500 + slab_float_error);
        // Nodes in float32 give straight compositing, except for roundings.
        scene.slice.tree = TreeSettings{.factors = {20, 30}};
        EXPECT_LE(linf(draw(volume, scene), straight), slab_float_error) << name_of(each);
        // 20 children and the root, each rounded by half a code in colour and opacity.
        scene.target = Target::fixed16;
        EXPECT_LE(linf(draw(volume, scene), straight), 21 * 255. / 65535 + slab_float_error)
            << name_of(each);
    }
}

// With codes of 16 bits, each slab rounds its opacity, its product with colour, and what it leaves
// of the pixel by half a code, and its colour before that.
TEST_P(LitSlabsOf, EmulatedTargetsAreLit) {
    const Volume volume = waves(12);
    for (const Classification each : both) {
        Scene scene = lit_scene(each, dim());
        scene.slice.samples = 60;
        const Image in_float = draw(volume, scene);
        scene.target = Target::emulated;
        scene.emulate = {16, AlphaRounding::nearest, OverRounding::fused, 3};
        EXPECT_LE(linf(draw(volume, scene), in_float),
                  (3 * 60 + 1) * .5 * 255 / 65535 + slab_float_error)
            << name_of(each);
    }
}

TEST_P(LitSlabsOf, BricksKnowTheGradientsOfTheirNeighbors) {
    const Volume volume = waves(30);
    Capabilities small = capabilities();
    small.max_texture_bytes = 16 * 75 * 53;
    for (const Classification each : both) {
        Scene scene = lit_scene(each, directional());
        scene.slice.samples = 300;
        // A segment that a face of a brick cuts becomes two, with another rounding.
        EXPECT_LE(linf(draw(volume, scene, {}, small), draw(volume, scene)), 2 * slab_float_error)
            << name_of(each);
    }
}

bool leaves_out(const Plan& plan, const std::string& name) {
    return std::ranges::find(plan.omitted, name, &Omission::name) != plan.omitted.end();
}

// Regions of one colour, or of one value, and transfer functions of one piece are not uniform if
// lit, because gradients differ.
TEST(LitSlabs, ThePlanLeavesOutNothingThatLightNeeds) {
    const Volume volume = test::volume_of<float>(
        unit_cube(20), [](double x, double, double) { return x < 10 ? 0 : 1; });
    for (const Classification each : both) {
        Scene scene = lit_scene(each, Lighting{});
        scene.transfer_function =
            TransferFunction::linear({knot(0, {1, 1, 1}, .1), knot(1, {1, 1, 1}, 2)});
        scene.slice.samples = 100;
        const Facts facts = measure(scene, volume, measure_bricks(volume));
        const auto plan_of = [&](const Scene& other) {
            return make_plan(other, facts, cpu_capabilities(), {});
        };
        const Plan lit = plan_of(scene);
        scene.lighting.reset();
        const Plan unlit = plan_of(scene);
        for (const char* const name : {"color", "constant_regions", "table"}) {
            EXPECT_FALSE(leaves_out(lit, name)) << name;
            const bool has_table = each == Classification::preintegrated;
            EXPECT_EQ(leaves_out(unlit, name), has_table || name != std::string("table")) << name;
        }
        EXPECT_TRUE(leaves_out(lit, "blending"));
        const std::string text = explain(lit, facts, cpu_capabilities());
        EXPECT_NE(text.find("light"), std::string::npos);
        EXPECT_EQ(text.find("off by up to"), std::string::npos);
    }
}

}  // namespace
}  // namespace lamina
