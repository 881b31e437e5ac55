// SPDX-License-Identifier: Apache-2.0
// Exact segments (docs/numerics.md, section 9) against closed forms and the reference tracer.
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "engine_fixture.h"
#include "exact_fixture.h"

namespace lamina {
namespace {

class ExactTest : public EngineTest {
  protected:
    template <typename Sample>
    void meets_the_tracer(Centering centering, double largest);
};

INSTANTIATE_TEST_SUITE_P(Contexts, ExactTest, every_engine, engine_name);

TEST_P(ExactTest, CubicOfACornerHasItsClosedForm) {
    // Extinction 4 s, along the diagonal 4 t^3: optical depth sqrt(3).
    const auto ramp = TransferFunction::linear({knot(0, {1, 1, 1}, 0), knot(1, {1, 1, 1}, 4)});
    const Image picture = draw(corner_cell(), diagonal_scene(ramp));
    EXPECT_NEAR(picture.rgba[3], -std::expm1(-std::sqrt(3.)), 1e-6);
    EXPECT_NEAR(picture.rgba[0], picture.rgba[3], 1e-6);
}

TEST_P(ExactTest, PeakInsideOneCellIsCutAtItsPoints) {
    // Extinction lies between s = .2 and .3 alone, so for t from .2^(1/3) to .3^(1/3).
    const TransferFunction box =
        TransferFunction::linear({knot(.2, {.5, 1, 0}, 0), knot(.2, {.5, 1, 0}, 7),
                                  knot(.3, {.5, 1, 0}, 7), knot(.3, {.5, 1, 0}, 0)});
    const Image picture = draw(corner_cell(), diagonal_scene(box));
    const double length = std::sqrt(3.) * (std::cbrt(.3) - std::cbrt(.2));
    const double opacity = -std::expm1(-7 * length);
    // The place t of a crossing is off by 2e-7 / (3 t^2).
    EXPECT_NEAR(picture.rgba[3], opacity, 4e-6);
    EXPECT_NEAR(picture.rgba[0], .5 * opacity, 4e-6);
    EXPECT_NEAR(picture.rgba[1], opacity, 4e-6);
}

// Along y = 1 - x the field x y is a parabola with its maximum, 1/4, in the middle.
TEST_P(ExactTest, TouchingAPointIsNotCrossingIt) {
    const Volume saddle = test::volume_of<float>(test::grid_of({2, 2, 2}, Centering::node),
                                                 [](double x, double y, double) { return x * y; });
    const auto opacity_above = [&](double value) {
        Scene scene = diagonal_scene(
            TransferFunction::linear({knot(value, {1, 1, 1}, 0), knot(value, {1, 1, 1}, 50)}));
        scene.camera->eye = {2.5, -1.5, .5};
        return draw(saddle, scene).rgba[3];
    };
    // Roundings of the scalar are some 1e-7; 2^-22 more is allowed, by which steps are moved where
    // scalars are sampled (sampled_step_advance). The ray is sqrt(2) long, and the share of it on
    // which the scalar comes so near to its maximum is at most the root of four times their sum.
    EXPECT_LE(opacity_above(.25 + 1e-6), 0);
    EXPECT_LE(opacity_above(.25), 50 * std::sqrt(2.) * std::sqrt(4 * (0x1p-22 + 1e-7)));
    const double open = std::sqrt(2.) * std::sqrt(4 * .01);  // x (1 - x) >= .24
    EXPECT_NEAR(opacity_above(.24), -std::expm1(-50 * open), 1e-5);
}

// Steps at the least and the largest sample, which a third of the samples have. A ray that meets an
// edge of two such corners, or passes a part of a cell whose scalars float32 rounds to theirs, must
// not see the other side of the step. No other ray touches it, and both sides are visible.
TEST_P(ExactTest, StepsAtTheEndsOfTheSamplesMeetTheTracer) {
    std::uint32_t state = 12345;
    const auto sample = [&](double, double, double) {
        state = state * 1664525u + 1013904223u;
        return std::clamp(250.0 + static_cast<double>(state >> 24) / 32, 252.0, 255.0);
    };
    const Volume volume =
        test::volume_of<std::uint8_t>(test::grid_of({17, 17, 17}, Centering::node), sample);
    for (const double value : {252, 255}) {
        for (const double extinction : {.3, 1e6}) {
            Scene scene = exact_scene(
                TransferFunction::linear({knot(value, {.9, .2, .1}, extinction),
                                          knot(value, {.1, .3, .8}, .3e6 / extinction)}),
                Projection::perspective);
            look_from(volume, {.4, -.7, .9}, 1.1, scene);
            scene.width = 160;
            scene.height = 120;
            EXPECT_LE(linf(draw(volume, scene), trace(volume, scene, 1e-8)), promised)
                << value << " " << extinction;
        }
    }
}

// In the outer half voxels of `cell` axes the field is constant wherever a ray sees one sample, or
// two equal ones. If that is the value of a step, they show the step's later side, whatever the
// other samples of the cell are.
TEST_P(ExactTest, StepsAtTheValuesOfTheBorderMeetTheTracer) {
    const auto show = [&](auto first) {
        using Sample = decltype(first);
        std::uint32_t state = 4711;
        const auto sample = [&](double, double, double) {
            state = state * 1664525u + 1013904223u;
            return double(first) * (1 + (state >> 30));
        };
        const Volume volume =
            test::volume_of<Sample>(test::grid_of({5, 2, 3}, Centering::cell), sample);
        for (const int times : {2, 3}) {
            const double step = static_cast<Sample>(double(first) * times);
            Scene scene = exact_scene(TransferFunction::linear({knot(step, {.9, .2, .1}, .01),
                                                                knot(step, {.1, .3, .8}, .2)}),
                                      Projection::perspective);
            look_from(volume, {.4, -.7, .9}, 1.2, scene);
            EXPECT_LE(linf(draw(volume, scene), trace(volume, scene, 1e-8)), promised) << step;
        }
    };
    show(std::uint8_t{60});
    show(std::int16_t{-711});
    show(.1f);
}

// With an optical depth of 4e6, the cell is opaque within a hundredth of its length from one side,
// and from the other within less than float32 can resolve.
TEST_P(ExactTest, DeepCellsHaveTheColorOfTheirFront) {
    const auto steep =
        TransferFunction::linear({knot(0, {0, 0, 0}, 0), knot(1, {1, .5, .25}, 1e7)});
    Scene scene = diagonal_scene(steep);
    const Image reference = trace(corner_cell(), scene, 1e-9);
    EXPECT_LE(linf(draw(corner_cell(), scene), reference), float_error);
    scene.camera->eye = {-3, -3, -3};
    EXPECT_LE(linf(draw(corner_cell(), scene), trace(corner_cell(), scene, 1e-9)), promised);
}

template <typename Sample>
void ExactTest::meets_the_tracer(Centering centering, double largest) {
    const Volume volume = noise<Sample>({13, 9, 11}, centering, largest);
    for_each_exact_scene(volume, [&](Scene& scene, const std::string& name) {
        const Image reference = trace(volume, scene, 1e-8);
        for (const int slabs : {1, 7, 512}) {
            scene.slice.samples = slabs;
            EXPECT_LE(linf(draw(volume, scene), reference), promised) << name << " " << slabs;
        }
    });
}

TEST_P(ExactTest, BytesMeetTheTracerWithAnyNumberOfSlabs) {
    meets_the_tracer<std::uint8_t>(Centering::cell, 255);
    meets_the_tracer<std::uint8_t>(Centering::node, 255);
}
TEST_P(ExactTest, WordsMeetTheTracerWithAnyNumberOfSlabs) {
    meets_the_tracer<std::uint16_t>(Centering::cell, 65535);
    meets_the_tracer<std::int16_t>(Centering::node, 3000);
}
TEST_P(ExactTest, FloatsMeetTheTracerWithAnyNumberOfSlabs) {
    meets_the_tracer<float>(Centering::cell, 1e-3);
    meets_the_tracer<float>(Centering::node, 1e6);
}

TEST_P(ExactTest, ThinVolumesMeetTheTracer) {
    for (const std::array<std::int64_t, 3> size :
         {std::array<std::int64_t, 3>{1, 9, 12}, {7, 1, 8}, {6, 9, 1}, {2, 2, 40}, {1, 1, 1}}) {
        const Volume volume = noise<std::uint8_t>(size, Centering::cell, 255);
        Scene scene = exact_scene(many_points(0, 255, .5), Projection::perspective);
        look_from(volume, {.5, .8, -.6}, 1.1, scene);
        EXPECT_LE(linf(draw(volume, scene), trace(volume, scene, 1e-8)), promised)
            << size[0] << " " << size[1] << " " << size[2];
    }
}

// If slabs are drawn one by one, their colours are not associated, and blending in float32 rounds
// by 2^-24 for each slab.
TEST_P(ExactTest, SlabsDrawnOneByOneMeetTheTracer) {
    const Volume volume = noise<std::uint8_t>({12, 10, 11}, Centering::cell, 255);
    Scene scene = exact_scene(in_view_of(volume, 4, steps), Projection::perspective);
    look_from(volume, {.4, -.7, .9}, 1.2, scene);
    const Image reference = trace(volume, scene, 1e-8);
    for (const Order order : {Order::back_to_front, Order::front_to_back}) {
        for (const int slabs : {1, 33, 700}) {
            scene.slice.order = order;
            scene.slice.samples = slabs;
            EXPECT_LE(linf(draw(volume, scene, keep("blending")), reference), promised);
            EXPECT_LE(linf(draw(volume, scene, leave_nothing_out()), reference), promised);
        }
    }
}

// A tree of nodes of 16 bits adds the roundings of its nodes, and no other error.
TEST_P(ExactTest, LeavesOfTreesAreExact) {
    const Volume volume = noise<std::uint8_t>({12, 10, 11}, Centering::cell, 255);
    Scene scene = exact_scene(in_view_of(volume, 4, peak), Projection::perspective);
    look_from(volume, {.4, -.7, .9}, 1.2, scene);
    const Image reference = trace(volume, scene, 1e-8);
    scene.target = Target::fixed16;
    scene.slice.tree = TreeSettings{.factors = {8, 8}};
    scene.slice.samples = 64;
    // 8 nodes of 16 bits and the root, each off by one or two codes in depth and in colour.
    EXPECT_LE(linf(draw(volume, scene), reference), 20 * full / 65535 + promised);
    scene.slice.tree = TreeSettings{.factors = {8, 8}, .nodes = NodeArithmetic::fixed};
    scene.transfer_function =
        TransferFunction::linear({knot(0, {1, 1, 1}, 0), knot(255, {1, 1, 1}, .3)});
    EXPECT_LE(linf(draw(volume, scene), trace(volume, scene, 1e-8)), 80 * full / 65535 + promised);
}

TEST_P(ExactTest, CellsBesideNanAreTransparent) {
    const Volume source = noise<float>({14, 12, 13}, Centering::cell, 1);
    std::vector<float> samples(static_cast<const float*>(source.data()),
                               static_cast<const float*>(source.data()) + 14 * 12 * 13);
    samples[500] = NAN;
    samples[1200] = INFINITY;
    const Volume volume = reference_test::make_volume(source.grid(), samples);
    Scene scene = exact_scene(in_view_of(source, 4, many_points), Projection::perspective);
    scene.nan = NanPolicy::transparent;
    look_from(volume, {.4, -.7, .9}, 1.2, scene);
    const Image picture = draw(volume, scene);
    EXPECT_LE(linf(picture, trace(volume, scene, 1e-8)), promised);
    EXPECT_GT(linf(picture, draw(source, scene)), 1);
}

// A region whose value is exactly that of a step shows the step's later side, whatever the range of
// the samples is.
TEST_P(ExactTest, LabelsAtStepsShowTheirLaterSide) {
    const auto show = [&](auto first, int label) {
        using Sample = decltype(first);
        const Volume volume = test::volume_of<Sample>(
            test::grid_of({9, 8, 7}, Centering::node),
            [&](double x, double, double) { return double(first) + label * (x < 4 ? 0 : 1); });
        const double step = static_cast<Sample>(double(first) + label);
        Scene scene = exact_scene(
            TransferFunction::linear({knot(step, {.2, .9, .1}, 0), knot(step, {.2, .9, .1}, .02)}),
            Projection::perspective);
        look_from(volume, {.4, -.7, .9}, 1.2, scene);
        const Image picture = draw(volume, scene);
        EXPECT_LE(linf(picture, trace(volume, scene, 1e-8)), float_error) << step << " " << label;
        EXPECT_GT(linf(picture, Image(scene.width, scene.height)), 10);
    };
    for (const int label : {1, 2, 3, 37, 100}) {
        show(std::uint8_t{5}, label);
        show(std::uint16_t{60001}, label);
        show(std::int16_t{-1024}, label);
        show(.1f, label);
    }
}

// Fill values for missing data (as in NetCDF) are farther from the other values than float32 has
// digits.
TEST_P(ExactTest, FillValuesShowNothing) {
    const Volume floats = noise<float>({13, 9, 11}, Centering::cell, 1);
    for (const float fill : {1e12f, 1e20f, 9.96921e36f, -3.4e38f}) {
        std::vector<float> samples(static_cast<const float*>(floats.data()),
                                   static_cast<const float*>(floats.data()) + 13 * 9 * 11);
        for (const std::size_t i : {200u, 500u, 501u, 900u}) samples[i] = fill;
        const Volume volume = reference_test::make_volume(floats.grid(), samples);
        // For such values double precision is not enough either, so the tracer draws smaller ones
        // that have the same meaning.
        for (const std::size_t i : {200u, 500u, 501u, 900u}) samples[i] = fill > 0 ? 1e9f : -1e9f;
        const Volume same = reference_test::make_volume(floats.grid(), samples);
        const auto shown = TransferFunction::linear(
            {knot(0, {1, .2, .1}, 0), knot(.001, {1, .2, .1}, .02), knot(.5, {.1, .9, .4}, .25),
             knot(1, {.2, .1, 1}, .1), knot(1, {.2, .1, 1}, 0)});
        Scene scene = exact_scene(shown, Projection::perspective);
        look_from(volume, {.4, -.7, .9}, 1.2, scene);
        const Image picture = draw(volume, scene);
        // No channel exceeds the largest colour, and no opacity exceeds 1, except by roundings.
        for (const float channel : picture.rgba) ASSERT_LE(std::abs(channel), 1 + 1e-5) << fill;
        // The cpu engine's pixels beside such values may be wrong (docs/precision.md).
        if (is_native()) continue;
        EXPECT_LE(linf(picture, trace(same, scene, 1e-8)), promised) << fill;
    }
}

// A transfer function of a single step has no width by which values could be scaled.
TEST_P(ExactTest, AStepAtZeroStaysAtZero) {
    const Volume volume = test::volume_of<float>(
        test::grid_of({12, 10, 11}, Centering::node),
        [](double x, double y, double z) { return std::sin(.9 * x + .3 * y * y) * (z - 4.3); });
    Scene scene = exact_scene(
        TransferFunction::linear({knot(0, {.2, .9, .1}, 0), knot(0, {.2, .9, .1}, .01)}),
        Projection::perspective);
    look_from(volume, {.4, -.7, .9}, 1.2, scene);
    EXPECT_LE(linf(draw(volume, scene), trace(volume, scene, 1e-8)), promised);
}

// A few outliers do not cost the visible values their digits.
TEST_P(ExactTest, OutliersChangeOnlyTheirOwnCells) {
    const Volume floats = noise<float>({13, 9, 11}, Centering::cell, 1);
    std::vector<float> samples(static_cast<const float*>(floats.data()),
                               static_cast<const float*>(floats.data()) + 13 * 9 * 11);
    samples[500] = -1e4f;
    samples[900] = 3e8f;
    const Volume volume = reference_test::make_volume(floats.grid(), samples);
    for (const NamedFunction& function : functions) {
        Scene scene = exact_scene(function.make(0, 1, .25), Projection::perspective);
        look_from(volume, {.4, -.7, .9}, 1.2, scene);
        EXPECT_LE(linf(draw(volume, scene), trace(volume, scene, 1e-8)), promised) << function.name;
    }
    std::uint32_t state = 1;
    const Volume words = test::volume_of<std::uint16_t>(
        test::grid_of({13, 9, 11}, Centering::node), [&](double x, double, double) {
            state = state * 1664525u + 1013904223u;
            return x == 3 ? 65535. : x == 8 ? 0. : 30000. + (state >> 24);
        });
    for (const NamedFunction& function : functions) {
        Scene scene = exact_scene(function.make(30000, 256, .25), Projection::perspective);
        look_from(words, {.4, -.7, .9}, 1.2, scene);
        EXPECT_LE(linf(draw(words, scene), trace(words, scene, 1e-8)), promised) << function.name;
    }
}

// Large regions of one value and large empty regions are crossed in one step.
TEST_P(ExactTest, RegionsCrossedInOneStepChangeNothing) {
    const Volume volume = test::volume_of<std::uint8_t>(
        test::grid_of({70, 50, 60}, Centering::cell), [](double x, double y, double z) {
            if (x < 30) return 0.;
            return y + z < 60 ? 90. : 200.;
        });
    const auto optics =
        TransferFunction::linear({knot(50, {.2, .9, .1}, 0), knot(80, {.2, .9, .1}, .02),
                                  knot(100, {.9, .1, .3}, .02), knot(220, {.3, .1, .9}, .08)});
    Scene scene = exact_scene(optics, Projection::perspective);
    look_from(volume, {.4, -.7, .9}, 1.2, scene);
    const Facts facts = measure(scene, volume, measure_bricks(volume));
    const Plan plan = make_plan(scene, facts, capabilities(), {});
    EXPECT_TRUE(plan.slice.occupied_only);
    EXPECT_EQ(plan.slice.constant_regions, is_native());
    const Image reference = trace(volume, scene, 1e-8);
    EXPECT_LE(linf(draw(volume, scene), reference), promised);
    EXPECT_LE(linf(draw(volume, scene, keep("constant_regions")), reference), promised);
    EXPECT_LE(linf(draw(volume, scene, keep("empty_space")), reference), promised);
}

TEST_P(ExactTest, BricksLeaveNoSeam) {
    const Volume volume = noise<std::uint8_t>({40, 30, 35}, Centering::cell, 255);
    Capabilities small = capabilities();
    small.max_texture_bytes = 16 * 64 * 48 + 4 * 1000;
    Scene scene = exact_scene(in_view_of(volume, 4, steps), Projection::perspective);
    look_from(volume, {.4, -.7, .9}, 1.2, scene);
    EXPECT_LE(linf(draw(volume, scene, {}, small), trace(volume, scene, 1e-8)), promised);
}

// llvmpipe ends all loops of a fragment after 65535 iterations together (plan/choices.h).
TEST_P(ExactTest, LongRaysAreDividedIfLoopsAreLimited) {
    const Volume volume = noise<std::uint8_t>({50, 50, 50}, Centering::cell, 255);
    std::vector<TransferKnot> knots;
    for (int i = 0; i < 200; ++i)
        knots.push_back(
            knot(1 + i * 1.27, {.5 + .5 * std::sin(i), .5, .1 * (i % 9)}, .01 * (i % 7)));
    Scene scene = exact_scene(TransferFunction::linear(knots), Projection::perspective);
    scene.width = 16;
    scene.height = 12;
    look_from(volume, {.4, -.7, .9}, 1.2, scene);
    const bool limited = !is_native() && capabilities().software;
    const Facts facts = measure(scene, volume, measure_bricks(volume));
    EXPECT_EQ(make_plan(scene, facts, capabilities(), {}).slice.slabs > 1, limited);
    EXPECT_LE(linf(draw(volume, scene), trace(volume, scene, 1e-8)), promised);
    scene.slice.classification = automatic;
    EXPECT_EQ(make_plan(scene, facts, capabilities(), {}).slice.classification,
              Classification::exact);
    EXPECT_LE(linf(draw(volume, scene), trace(volume, scene, 1e-8)), promised);
    scene.slice.samples = 1;  // too few for exact segments
    EXPECT_EQ(make_plan(scene, facts, capabilities(), {}).slice.classification,
              limited ? Classification::post : Classification::exact);
    scene.slice.tree = TreeSettings{.factors = {2}};
    scene.slice.samples = 64;
    EXPECT_NO_THROW(make_plan(scene, facts, capabilities(), {}));
    if (!limited) return;
    scene.slice.tree.reset();
    scene.slice.classification = Classification::exact;
    scene.slice.samples = 1;
    try {
        draw(volume, scene);
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("--context cpu"), std::string::npos);
    }
}

TEST_P(ExactTest, LeavesOfATreeGiveTheNumberOfSlabs) {
    const Volume volume = gaussians(8);
    Scene scene = exact_scene(smooth_transfer_function(), Projection::perspective);
    scene.target = Target::fixed8;
    scene.slice.tree = TreeSettings{.factors = {4, 16}};
    const Facts facts = measure(scene, volume, measure_bricks(volume));
    EXPECT_EQ(make_plan(scene, facts, capabilities(), {}).slice.slabs, 64);
}

using ShadersOfGpus = SlicingTest;

// Only GPUs leave parts of which nothing shows. These scalars lie in front of, between and behind
// intervals that show, which begin with steps and with slopes, and some lie on the steps.
TEST_F(ShadersOfGpus, DrawWhatThoseOfSoftwareDraw) {
    const Volume volume = noise<std::uint8_t>({14, 12, 13}, Centering::cell, 8);
    for (const bool one_color : {false, true}) {
        for (const bool lit : {false, true}) {
            const glm::dvec3 other = one_color ? glm::dvec3{1, .2, .1} : glm::dvec3{.1, .9, .4};
            Scene scene =
                exact_scene(TransferFunction::linear(
                                {knot(2, {1, .2, .1}, 0), knot(2, {1, .2, .1}, .4),
                                 knot(3, other, .3), knot(3, other, 0), knot(4.5, other, 0),
                                 knot(5, other, 2), knot(5.5, {1, .2, .1}, 0)}),
                            Projection::perspective);
            if (lit) {
                Lighting lighting;
                lighting.smallest_gradient = .01;
                scene.lighting = lighting;
            }
            look_from(volume, {.4, -.7, .9}, 1.2, scene);
            const Facts facts = measure(scene, volume, measure_bricks(volume));
            SlicePlan plan = make_plan(scene, facts, capabilities(), {}).slice;
            const auto drawn = [&](int batches) {
                plan.batches = batches;
                GlSliceRenderer renderer(volume, *scene.transfer_function, facts, plan,
                                         capabilities(), scene.width, scene.height);
                renderer.draw(View(*scene.camera, scene.width, scene.height));
                return renderer.read();
            };
            const Image software = drawn(64);
            EXPECT_GT(software.rgba[3 + 4 * (22 * 60 + 30)], 0);
            EXPECT_EQ(drawn(1).rgba, software.rgba) << one_color << lit;
        }
    }
}

}  // namespace
}  // namespace lamina
