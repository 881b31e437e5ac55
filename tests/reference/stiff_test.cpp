// SPDX-License-Identifier: Apache-2.0
// Tests surfaces and thin shells: extinction up to 1e7 per unit, transfer functions with spikes of
// width 1e-4.
#include <gtest/gtest.h>

#include "fixtures.h"
#include "optics/segment_integral.h"

namespace lamina {
namespace {

using namespace reference_test;

// Returns a ramp along x from 0 to 1, over `cells` cells of total length 1.
Volume ramp_volume(int cells) {
    const Grid grid = make_grid({cells + 1, 2, 2}, Centering::node, {1.0 / cells, 1, 1});
    std::vector<float> samples;
    for (int copy = 0; copy < 4; ++copy) {
        for (int i = 0; i <= cells; ++i)
            samples.push_back(static_cast<float>(i) / static_cast<float>(cells));
    }
    return make_volume<float>(grid, samples);
}

TraceResult trace_along_x(const Volume& volume, const TransferFunction& function, bool backwards) {
    Camera camera;
    camera.projection = Projection::orthographic;
    camera.eye = {backwards ? 3.0 : -2.0, 0.5, 0.5};
    camera.center = {0.5, 0.5, 0.5};
    return trace_volume(volume, function, View(camera, 1, 1), {1e-12});
}

void expect_segment(const TransferFunction& function, int cells, double rounding) {
    const Volume volume = ramp_volume(cells);
    for (const bool backwards : {false, true}) {
        const TraceResult result = trace_along_x(volume, function, backwards);
        const SegmentIntegral expected =
            integrate_segment(function, backwards ? 1 : 0, backwards ? 0 : 1, 1);
        EXPECT_LE(result.error_estimate, 1e-12);
        const auto& rgba = result.image.rgba;
        EXPECT_NEAR(rgba[3], expected.alpha, 1e-12 + rounding);
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(rgba[static_cast<std::size_t>(c)], expected.color[c], 1e-12 + rounding);
        }
    }
}

TEST(Stiff, RampsOfAnyDensityEqualOneSegment) {
    for (const double extinction : {1.0, 1e2, 1e4, 1e7}) {
        for (const int cells : {1, 2, 16, 256}) {
            SCOPED_TRACE(testing::Message() << extinction << " in " << cells << " cells");
            expect_segment(ramp_function(extinction), cells, 2e-13);
        }
    }
}

TEST(Stiff, SurfacesBehindAStepEqualOneSegment) {
    for (const double step : {0.3, 0.5, 0.7}) {  // in a cell, on a plane between cells, in a cell
        for (const int cells : {1, 2, 16}) {
            expect_segment(TransferFunction::linear({{0, {{1, 0, 0}, 0.5}},
                                                     {step, {{1, 1, 0}, 1}},
                                                     {step, {{0, 0, 1}, 1e7}},
                                                     {1, {{0, 1, 0}, 1e7}}}),
                           cells, 2e-13);
        }
    }
}

TEST(Stiff, ThinSpikesEqualOneSegment) {
    for (const double peak : {1e2, 1e4, 1e7}) {
        for (const int cells : {1, 2, 16}) {
            SCOPED_TRACE(testing::Message() << peak << " in " << cells << " cells");
            // Places on the ray have errors of 1e-16, which is 1e-12 of the spike's width of 1e-4.
            // Such an error of a depth d changes the result by d exp(-d) <= 0.4 of it.
            expect_segment(TransferFunction::linear({{0.41, {{1, 0, 0}, 0}},
                                                     {0.41005, {{0, 1, 0}, peak}},
                                                     {0.4101, {{0, 0, 1}, 0}}}),
                           cells, 2e-12);
        }
    }
}

// In a picture of random cells with a surface and a spike, all numbers are finite, the time is
// bounded, and errors are within the estimate.
TEST(Stiff, PicturesOfSurfacesKeepTheErrorEstimate) {
    Random random(31);
    const Grid grid = make_grid({12, 12, 12}, Centering::cell);
    const Volume volume = make_volume<float>(grid, random_samples(grid, random));
    const TransferFunction function = TransferFunction::linear({{0.3, {{1, 0.5, 0}, 0}},
                                                                {0.30005, {{0, 1, 0.5}, 300}},
                                                                {0.3001, {{1, 1, 1}, 0}},
                                                                {0.8, {{1, 0, 1}, 0}},
                                                                {0.8, {{0, 0, 1}, 1e7}},
                                                                {1, {{1, 1, 0}, 1e7}}});
    const View view(camera_at(grid, Projection::perspective, {1, 2, 3}, 1), 48, 36);
    const TraceResult fine = trace_volume(volume, function, view, {1e-11});
    for (const double tolerance : {1e-3, 1e-5, 1e-9}) {
        const TraceResult result = trace_volume(volume, function, view, {tolerance});
        EXPECT_LE(result.error_estimate, tolerance);
        EXPECT_LE(largest_difference(result.image, fine.image),
                  result.error_estimate + fine.error_estimate);
    }
    EXPECT_GT(largest_alpha(fine.image), 0.999);
}

TEST(Stiff, ExtremeExtinctionShowsTheFront) {
    const Volume volume = ramp_volume(4);
    const TraceResult result = trace_along_x(volume, ramp_function(1e300), false);
    EXPECT_EQ(result.image.rgba[3], 1);
    // The colour is that of value 0, at the very front: the visible layer is 1e-150 thin.
    EXPECT_NEAR(result.image.rgba[0], 0, 1e-12);
    EXPECT_NEAR(result.image.rgba[2], 1, 1e-12);
}

}  // namespace
}  // namespace lamina
