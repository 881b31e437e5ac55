// SPDX-License-Identifier: Apache-2.0
// Tests the invariants of docs/numerics.md, section 10, on lit volumes.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <optional>

#include "base/error.h"
#include "lit_fixtures.h"

namespace lamina {
namespace {

using namespace reference_test;

constexpr double volume_tolerance = 1e-11;  // of each picture; both err by that at most

struct Lit {
    Grid grid;
    std::vector<float> samples;
    TransferFunction function;

    TraceResult trace(const Camera& camera, const std::optional<Lighting>& lighting) const {
        return trace_volume(make_volume<float>(grid, samples), function, View(camera, 25, 20),
                            {volume_tolerance, lighting});
    }
};

Lit noise(Centering centering) {
    Random random(22);
    const Grid grid = make_grid({6, 5, 4}, centering, {0.5, 0.75, 1.25});
    std::vector<float> samples = random_samples(grid, random);
    return {grid, std::move(samples), random_function(random, 2, 0, 3)};
}

// The grid is turned, the field linear; values are exact in float32. All rays are parallel, so one
// q and w hold for all of them.
TEST(LitVolume, ALinearFieldIsTheUnlitPictureTimesAConstant) {
    Grid grid;
    grid.size = {6, 4, 5};
    grid.centering.fill(Centering::cell);
    grid.step = {glm::dvec3(2, 1, 2) * .25, glm::dvec3(-2, 2, 1) * .5, glm::dvec3(1, 2, -2) * .25};
    const glm::dvec3 gradient(.25, -.125, .5);
    std::vector<float> samples;
    for (int k = 0; k < 5; ++k)
        for (int j = 0; j < 4; ++j)
            for (int i = 0; i < 6; ++i)
                samples.push_back(static_cast<float>(glm::dot(gradient, grid.to_world({i, j, k}))));
    Random random(3);
    const Lit lit{grid, samples, random_function(random, 2, 2, 4)};
    for (const Centering centering : {Centering::node, Centering::cell}) {
        Lit other = lit;
        other.grid.centering = {centering, centering, centering};
        const Camera camera = camera_at(other.grid, Projection::orthographic, {1, 2, 3}, 1);
        const PreciseImage unlit = other.trace(camera, {}).image;
        const PreciseImage found = other.trace(camera, directional()).image;
        EXPECT_GT(largest_alpha(found), .5);
        for (int row = 0; row < 20; ++row) {
            for (int column = 0; column < 25; ++column) {
                const double* const a = unlit.pixel(column, row);
                const double* const b = found.pixel(column, row);
                const glm::dvec3 expected = lit_by_one_gradient(
                    {a[0], a[1], a[2]}, a[3], gradient, directional(), camera.center - camera.eye);
                ASSERT_EQ(b[3], a[3]);
                // Errors: the unlit one times at most 2, the lit one, and rounding.
                for (int c = 0; c < 3; ++c)
                    ASSERT_NEAR(b[c], expected[c], 3 * volume_tolerance + 1e-13);
            }
        }
    }
}

TEST(LitVolume, AmbientAloneAndNoWeightAreTheUnlitPicture) {
    Lighting no_weight = directional();
    no_weight.smallest_gradient = Lighting::largest_gradient;
    for (const Centering centering : {Centering::node, Centering::cell}) {
        const Lit scene = noise(centering);
        for (const Camera& camera : cameras(scene.grid)) {
            const PreciseImage unlit = scene.trace(camera, {}).image;
            EXPECT_EQ(scene.trace(camera, ambient_alone()).image.rgba, unlit.rgba);
            EXPECT_EQ(scene.trace(camera, no_weight).image.rgba, unlit.rgba);
            const PreciseImage lit = scene.trace(camera, directional()).image;
            EXPECT_GT(largest_difference(lit, unlit), .05);
            for (std::size_t i = 3; i < lit.rgba.size(); i += 4)
                EXPECT_EQ(lit.rgba[i], unlit.rgba[i]);
        }
    }
}

// Scaling the world by powers of two changes no digit of the tracer's numbers.
TEST(LitVolume, ScalingTheWorldByPowersOfTwoChangesNothing) {
    const Lit scene = noise(Centering::cell);
    for (const double s : {8., 0x1p-30}) {
        Lit scaled = scene;
        for (glm::dvec3& step : scaled.grid.step) step *= s;
        std::vector<TransferKnot> knots(scene.function.knots().begin(),
                                        scene.function.knots().end());
        for (TransferKnot& knot : knots) knot.optics.extinction /= s;
        scaled.function = TransferFunction::linear(knots);
        Lighting lighting = directional();
        lighting.smallest_gradient = *lighting.smallest_gradient / s;
        for (const Camera& camera : cameras(scene.grid)) {
            Camera other = camera;
            other.eye *= s;
            other.center *= s;
            other.height *= s;
            EXPECT_LE(largest_difference(scene.trace(camera, directional()).image,
                                         scaled.trace(other, lighting).image),
                      1e-13)
                << s;
        }
    }
}

// Turns scene, lights and camera together. Places of rays are rounded by some 1e-15 of the eye's
// distance of 4. Extinction changes by at most 3 / .02 per unit of the scalar; light by at most the
// change of the gradient (10) divided by the smallest gradient (.5), times its power (5). Both make
// less than 1e3 * 1e-14 of the rounding.
TEST(LitVolume, TurningEverythingChangesNothing) {
    const glm::dmat3 turns[] = {glm::dmat3({0, 1, 0}, {0, 0, 1}, {1, 0, 0}),
                                glm::dmat3({2. / 3, 1. / 3, 2. / 3}, {-2. / 3, 2. / 3, 1. / 3},
                                           {-1. / 3, -2. / 3, 2. / 3})};
    for (const Centering centering : {Centering::node, Centering::cell}) {
        const Lit scene = noise(centering);
        for (const glm::dmat3& turn : turns) {
            Lit turned = scene;
            for (glm::dvec3& step : turned.grid.step) step = turn * step;
            turned.grid.origin = turn * scene.grid.origin;
            Lighting lighting = directional();
            for (Light& light : lighting.lights) light.direction = turn * *light.direction;
            for (const Camera& camera : cameras(scene.grid)) {
                Camera other = camera;
                other.eye = turn * camera.eye;
                other.center = turn * camera.center;
                other.up = turn * camera.up;
                EXPECT_LE(largest_difference(scene.trace(camera, directional()).image,
                                             turned.trace(other, lighting).image),
                          2 * volume_tolerance + 1e-11);
            }
        }
    }
}

// The field is a plateau with noise of 3e-4 of the range of values. Gradients of up to 3e-4 sqrt(3)
// per spacing have a weight of .0027, and light takes at most .9 of the colour (docs/numerics.md,
// section 10).
TEST(LitVolume, NoiseInFlatRegionsDoesNotShow) {
    const Grid grid = make_grid({12, 12, 12}, Centering::node);
    Random random(7);
    std::vector<float> samples;
    for (std::int64_t i = 0; i < grid.sample_count(); ++i)
        samples.push_back(static_cast<float>(.5 + random.uniform(-3e-4, 3e-4)));
    const Lit flat{grid, samples, constant_function(1, glm::dvec3(1))};
    Lighting lighting;
    lighting.smallest_gradient = .01;  // scalar units per spacing; the range is 1
    for (const Camera& camera : cameras(grid)) {
        const double difference =
            largest_difference(flat.trace(camera, {}).image, flat.trace(camera, lighting).image);
        EXPECT_LE(difference, .9 * .0027);
        EXPECT_LT(difference, 1. / 255);
        EXPECT_GT(difference, 0);
    }
}

TEST(LitVolume, NanCellsAreTransparentAndLeaveNeighborsLit) {
    Lit scene = noise(Centering::node);
    for (const std::size_t hole : {40, 41, 77}) scene.samples[hole] = NAN;
    for (const Camera& camera : cameras(scene.grid)) {
        const PreciseImage unlit = scene.trace(camera, {}).image;
        const PreciseImage lit = scene.trace(camera, directional()).image;
        EXPECT_GT(largest_difference(lit, unlit), .05);
        for (std::size_t i = 0; i < lit.rgba.size(); ++i) {
            ASSERT_TRUE(std::isfinite(lit.rgba[i]));
            if (i % 4 == 3) {
                ASSERT_EQ(lit.rgba[i], unlit.rgba[i]);
            }
        }
    }
}

TEST(LitVolume, NumberOfThreadsDoesNotMatter) {
    const Lit scene = noise(Centering::cell);
    const Camera camera = cameras(scene.grid).front();
    const TraceResult many = scene.trace(camera, directional());
    const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
    const TraceResult one = scene.trace(camera, directional());
    EXPECT_EQ(many.image.rgba, one.image.rgba);
    EXPECT_EQ(many.error_estimate, one.error_estimate);
}

// The estimate is within the tolerance, and the true error (against a picture with tolerance 1e-11)
// is within the estimate. 1e-13: rounding.
TEST(LitVolume, TheErrorEstimateCoversTheError) {
    Random random(43);
    for (int i = 0; i < 24; ++i) {
        const Grid grid =
            make_grid({5, 6, 4}, i % 2 ? Centering::node : Centering::cell, {1, .5, .75});
        const Volume volume = make_volume<float>(grid, random_samples(grid, random));
        const TransferFunction function =
            random_function(random, random.below(3), random.below(2), random.uniform(.1, 20));
        const Lighting lighting = random_lighting(random);
        const View view(camera_at(grid, i % 3 ? Projection::perspective : Projection::orthographic,
                                  random.point(-1, 1), random.uniform(.3, 1)),
                        12, 10);
        const TraceResult exact = trace_volume(volume, function, view, {1e-11, lighting});
        EXPECT_LE(exact.error_estimate, 1e-11);
        for (const double each : {1e-2, 1e-4, 1e-5, 1e-6, 1e-8}) {
            const TraceResult result = trace_volume(volume, function, view, {each, lighting});
            EXPECT_LE(result.error_estimate, each);
            EXPECT_LE(largest_difference(result.image, exact.image),
                      result.error_estimate + exact.error_estimate + 1e-13)
                << i << " " << each;
        }
    }
}

TEST(LitVolume, AMissingSmallestGradientIsAnError) {
    const Lit scene = noise(Centering::cell);
    EXPECT_THROW(scene.trace(cameras(scene.grid).front(), Lighting{}), Error);
}

}  // namespace
}  // namespace lamina
