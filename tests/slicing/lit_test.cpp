// SPDX-License-Identifier: Apache-2.0
// Lit exact segments (docs/numerics.md, section 10) against a closed form and the reference tracer.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine_fixture.h"
#include "plan/choices.h"
#include "reference/lit_fixtures.h"
#include "support/expect_error.h"
#include "support/volume_of.h"

namespace lamina {
namespace {

using reference_test::directional;
using reference_test::lightings;
using reference_test::lit_by_one_gradient;

// Error, in 1/255, of sums of a few hundred roundings of float32 at full scale, and of the rounding
// of gradients: 2^-15 of each corner's, which changes light by less than half of that.
constexpr double lit_float_error = .02;

template <typename Sample>
Volume noise(const Grid& grid, double largest) {
    std::uint32_t state = 12345;
    return test::volume_of<Sample>(grid, [&](double, double, double) {
        state = state * 1664525u + 1013904223u;
        return largest * (state >> 8) / 0x1p24;
    });
}

// Returns a volume of a few waves, with gradients of every size.
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
    scene.slice.classification = automatic;
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
    scene.camera->center = reference_test::middle_of(grid);
    scene.camera->eye = scene.camera->center + distance * diagonal * glm::normalize(direction);
    scene.camera->height = .8 * diagonal;
}

Image traced(const Volume& volume, const Scene& scene) {
    return to_float(trace_volume(volume, *scene.transfer_function,
                                 View(*scene.camera, scene.width, scene.height),
                                 {1e-6, copied_lighting(scene.lighting)})
                        .image);
}

class LitTest : public EngineTest {
  protected:
    void keeps_max_error(const Volume& volume, double smallest_share);
    void keeps_max_error(const Volume& volume, Scene& scene, const Image& reference);
};

INSTANTIATE_TEST_SUITE_P(Contexts, LitTest, every_engine, engine_name);

void LitTest::keeps_max_error(const Volume& volume, Scene& scene, const Image& reference) {
    for (const double max_error : {1., 4.}) {
        scene.max_error = max_error;
        EXPECT_LE(linf(draw(volume, scene), reference), max_error)
            << name_of(scene.camera->projection) << ", power " << (*scene.lighting)->power;
    }
}

void LitTest::keeps_max_error(const Volume& volume, double smallest_share) {
    for (const Lighting& lighting : lightings()) {
        Scene scene = lit_scene(volume, 5, lighting, smallest_share);
        for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
            scene.camera->projection = projection;
            look_from(volume, {.4, -.7, .9}, projection == Projection::perspective ? .4 : 1, scene);
            keeps_max_error(volume, scene, traced(volume, scene));
        }
    }
}

Grid turned(const std::array<std::int64_t, 3>& size, Centering centering) {
    Grid grid = test::grid_of(size, centering);
    grid.origin = {3, -5, 7};
    grid.step = {glm::dvec3(2, 1, 2) * .25, glm::dvec3(-2, 2, 1) * .5, glm::dvec3(1, 2, -2) * .3};
    return grid;
}

TEST_P(LitTest, SmoothFieldsKeepMaxError) {
    keeps_max_error(waves<std::uint8_t>(test::grid_of({17, 13, 15}, Centering::cell), 255), .01);
    keeps_max_error(waves<float>(turned({13, 17, 11}, Centering::node), 1e-3), .01);
    keeps_max_error(waves<std::int16_t>(turned({11, 9, 13}, Centering::cell), 3000), .003);
}

TEST_P(LitTest, NoiseKeepsMaxError) {
    keeps_max_error(noise<std::uint8_t>(test::grid_of({13, 9, 11}, Centering::cell), 255), .01);
    keeps_max_error(noise<std::uint16_t>(turned({9, 8, 11}, Centering::node), 65535), .05);
}

TEST_P(LitTest, ThinVolumesKeepMaxError) {
    for (const std::array<std::int64_t, 3> size :
         {std::array<std::int64_t, 3>{1, 9, 12}, {7, 1, 8}, {6, 9, 1}, {2, 2, 14}, {1, 1, 1}})
        keeps_max_error(waves<float>(test::grid_of(size, Centering::cell), 1), .01);
}

// Samples are exact in binary, and so are their differences. Rays are parallel, so light is the
// same everywhere.
TEST_P(LitTest, ALinearFieldIsTheUnlitPictureTimesAConstant) {
    const Grid grid = turned({8, 6, 7}, Centering::cell);
    const glm::dvec3 gradient(.25, -.125, .5);
    const Volume volume = test::volume_of<float>(grid, [&](double x, double y, double z) {
        return glm::dot(gradient, grid.to_world({x, y, z}));
    });
    Scene scene = lit_scene(volume, 3, directional(), .05);
    scene.camera->projection = Projection::orthographic;
    look_from(volume, {.4, -.7, .9}, 1, scene);
    Scene unlit = scene;
    unlit.lighting.reset();
    const Image lit = draw(volume, scene), plain = draw(volume, unlit);
    for (int row = 0; row < scene.height; ++row) {
        for (int column = 0; column < scene.width; ++column) {
            const float *const a = plain.pixel(column, row), *const b = lit.pixel(column, row);
            const glm::dvec3 expected =
                lit_by_one_gradient({a[0], a[1], a[2]}, a[3], gradient, **scene.lighting,
                                    scene.camera->center - scene.camera->eye);
            // Lit rays are walked in double precision, and unlit ones in floats.
            ASSERT_NEAR(b[3], a[3], lit_float_error / 255);
            for (int c = 0; c < 3; ++c) ASSERT_NEAR(b[c], expected[c], 2 * lit_float_error / 255);
        }
    }
}

TEST_P(LitTest, AmbientAloneIsTheUnlitPicture) {
    const Volume volume = noise<float>(test::grid_of({9, 8, 7}, Centering::node), 1);
    Scene scene = lit_scene(volume, 5, reference_test::ambient_alone(), .01);
    look_from(volume, {.4, -.7, .9}, .6, scene);
    const Image lit = draw(volume, scene);
    scene.lighting.reset();
    EXPECT_LE(linf(lit, draw(volume, scene)), lit_float_error);
}

// Gradients beside NaN samples are one-sided differences; cells without a NaN corner are visible.
TEST_P(LitTest, NanCellsAreTransparent) {
    std::uint32_t state = 7;
    const Volume volume = test::volume_of<float>(
        test::grid_of({9, 8, 7}, Centering::cell), [&](double x, double, double) {
            state = state * 1664525u + 1013904223u;
            return state % 13 == 0 ? NAN : std::sin(.7 * x) + (state >> 8) / 0x1p25;
        });
    Scene scene = lit_scene(volume, 5, Lighting{}, .01);
    scene.nan = NanPolicy::transparent;
    look_from(volume, {.4, -.7, .9}, .6, scene);
    EXPECT_LE(linf(draw(volume, scene), traced(volume, scene)), 1);
}

// The part of a ray in a leaf of a tree is lit as in a ray without a tree.
TEST_P(LitTest, TreesKeepTheColors) {
    const Volume volume = waves<float>(test::grid_of({9, 8, 7}, Centering::node), 1);
    Scene scene = lit_scene(volume, 5, directional(), .01);
    look_from(volume, {.4, -.7, .9}, .6, scene);
    scene.slice.tree = TreeSettings{.factors = {4, 8}};
    EXPECT_LE(linf(draw(volume, scene), traced(volume, scene)), 1);
}

TEST(LitPlans, LeaveOutWhatLightDoesNotNeed) {
    const Volume volume =
        test::volume_of<float>(test::grid_of({20, 20, 20}, Centering::node),
                               [](double x, double, double) { return x < 10 ? 0 : 1; });
    Scene scene =
        unit_box_scene(TransferFunction::linear({knot(0, {1, 1, 1}, .1), knot(1, {1, 1, 1}, 2)}),
                       Projection::perspective);
    scene.slice.classification = Classification::exact;
    const auto plan_of = [&](const Scene& each) {
        return make_plan(each, measure(each, volume, measure_bricks(volume)), cpu_capabilities(),
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
    EXPECT_NE(explain(plan, facts, cpu_capabilities()).find("light"), std::string::npos);
}

// Fill values for missing data, and a smallest gradient far below all gradients of the data. Rays
// pass near the hidden fill values, where gradients are long.
TEST_P(LitTest, FillValuesKeepMaxError) {
    const Grid grid = test::grid_of({14, 12, 13}, Centering::cell);
    const auto beside = [&](float fill) {
        return test::volume_of<float>(grid, [&](double x, double y, double z) -> double {
            const double away = std::max({std::abs(x - 6), std::abs(y - 5), std::abs(z - 7)});
            if (away < 2) return fill;
            // A hidden layer, so that no visible cell has a fill value at a corner.
            return away < 3 ? 1.2 : .5 + .4 * std::sin(.5 * x + .3 * y * std::sin(.2 * z));
        });
    };
    // Double precision is not enough for 1e20, so the tracer draws smaller values with the same
    // meaning.
    const Volume same = beside(1e9f);
    for (const double smallest : {.01, 1e-9}) {
        Scene scene = unit_box_scene(
            TransferFunction::linear({knot(0, {1, .2, .1}, 0), knot(.2, {1, .2, .1}, .1),
                                      knot(.5, {.1, .9, .4}, .3), knot(1, {.2, .1, 1}, .2),
                                      knot(1, {.2, .1, 1}, 0)}),
            Projection::perspective, 60, 45);
        scene.slice.classification = Classification::exact;
        scene.lighting = directional();
        (*scene.lighting)->smallest_gradient = smallest;
        look_from(same, {.4, -.7, .9}, .9, scene);
        const Image reference = traced(same, scene);
        for (const float fill : {1e9f, 1e20f}) keeps_max_error(beside(fill), scene, reference);
    }
}

// In the outer half voxels the border's gradient repeats, however long its neighbour's gradient is.
TEST_P(LitTest, OuterHalfVoxelsHaveTheBordersGradient) {
    const Volume volume = test::volume_of<float>(
        test::grid_of({8, 9, 7}, Centering::cell), [](double x, double y, double z) {
            if (x == 5) return 1e9;
            return x == 4 || x == 6 ? 1.2 : .5 + .4 * std::sin(.7 * y + .9 * z + x);
        });
    Scene scene =
        unit_box_scene(TransferFunction::linear({knot(0, {1, .2, .1}, .1), knot(1, {.2, .1, 1}, .4),
                                                 knot(1, {.2, .1, 1}, 0)}),
                       Projection::perspective, 60, 45);
    scene.slice.classification = Classification::exact;
    scene.lighting = directional();
    (*scene.lighting)->smallest_gradient = .01;
    look_from(volume, {.9, -.5, .4}, .9, scene);
    keeps_max_error(volume, scene, traced(volume, scene));
}

// Steep and gentle gradients in one volume, 1e9 times apart.
TEST_P(LitTest, GradientsOfAllSizesKeepMaxError) {
    const Volume volume = test::volume_of<float>(
        test::grid_of({13, 12, 11}, Centering::node), [](double x, double y, double z) {
            return x > 9 ? 1 + y : 1e-9 * (.5 + .4 * std::sin(.5 * x + .3 * y * std::sin(.2 * z)));
        });
    Scene scene = unit_box_scene(
        TransferFunction::linear({knot(0, {1, .2, .1}, 0), knot(.5e-9, {.1, .9, .4}, .3),
                                  knot(1e-9, {.2, .1, 1}, .2), knot(2e-9, {.2, .1, 1}, 0)}),
        Projection::perspective, 60, 45);
    scene.slice.classification = Classification::exact;
    scene.lighting = directional();
    (*scene.lighting)->smallest_gradient = 1e-11;
    look_from(volume, {-.8, -.7, .9}, .9, scene);
    keeps_max_error(volume, scene, traced(volume, scene));
}

TEST_P(LitTest, BricksLeaveNoSeam) {
    const Volume volume = waves<float>(test::grid_of({40, 30, 35}, Centering::cell), 1);
    Capabilities small = capabilities();
    small.max_texture_bytes = 16 * 60 * 45;  // as much as the picture takes
    Scene scene = lit_scene(volume, 5, directional(), .01);
    look_from(volume, {.4, -.7, .9}, .6, scene);
    const Facts facts = measure(scene, volume, measure_bricks(volume));
    EXPECT_GT(make_plan(scene, facts, small, {}).slice.bricks.size(), 1u);
    EXPECT_LE(linf(draw(volume, scene, {}, small), traced(volume, scene)), 1);
}

// Slabs are drawn one by one, and with nothing left out.
TEST_P(LitTest, SlabsDrawnOneByOneAreLit) {
    const Volume volume = waves<std::uint8_t>(test::grid_of({12, 10, 11}, Centering::cell), 255);
    Scene scene = lit_scene(volume, 5, Lighting{}, .01);
    look_from(volume, {.4, -.7, .9}, .6, scene);
    const Image reference = traced(volume, scene);
    for (const int slabs : {1, 40}) {
        scene.slice.samples = slabs;
        EXPECT_LE(linf(draw(volume, scene, keep("blending")), reference), 1);
        EXPECT_LE(linf(draw(volume, scene, leave_nothing_out()), reference), 1);
    }
    scene.slice.samples = automatic;
    scene.target = Target::fixed16;
    EXPECT_LE(linf(draw(volume, scene), reference), 1.1);
}

TEST_P(LitTest, ClippedVolumesAreLit) {
    const Volume volume = waves<std::uint8_t>(test::grid_of({12, 10, 11}, Centering::cell), 255);
    Scene scene = lit_scene(volume, 5, directional(), .01);
    look_from(volume, {.4, -.7, .9}, .6, scene);
    scene.clip.planes = {{reference_test::middle_of(volume.grid()), {.3, -.5, 1}}};
    EXPECT_LE(linf(draw(volume, scene), trace(volume, scene, 1e-6)), 1);
}

TEST_P(LitTest, AnAutomaticSmallestGradientIsRefused) {
    const Volume volume = waves<float>(test::grid_of({5, 5, 5}, Centering::node), 1);
    Scene scene = lit_scene(volume, 5, Lighting{}, .01);
    (*scene.lighting)->smallest_gradient = automatic;
    expect_error([&] { draw(volume, scene); }, {"lighting.smallest_gradient"});
}

// llvmpipe ends all loops of a fragment after 65535 rounds together (plan/choices.h).
TEST_P(LitTest, TooManyCutsAreRefusedIfLoopsAreLimited) {
    const Volume volume = waves<float>(test::grid_of({5, 5, 5}, Centering::node), 1);
    Scene scene = lit_scene(volume, 5, Lighting{}, .01);
    scene.max_error = .01;
    if (is_native() || !capabilities().software) {
        EXPECT_NO_THROW(draw(volume, scene));
        return;
    }
    expect_error([&] { draw(volume, scene); }, {"render.max_error", "found 0.01", "--context cpu"});
    const Facts facts = measure(scene, volume, measure_bricks(volume));
    scene.max_error = 1.001 * least_lit_error(scene, facts, capabilities());
    EXPECT_NO_THROW(make_plan(scene, facts, capabilities(), {}));
    EXPECT_GT(scene.max_error, .1);
    EXPECT_LT(scene.max_error, 1);
}

}  // namespace
}  // namespace lamina
