// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "base/error.h"
#include "fixtures.h"

namespace lamina {
namespace {

using namespace reference_test;

struct Judged {
    Volume volume;
    TransferFunction function;
    View view;
};

std::vector<Judged> scenes() {
    Random random(41);
    const Grid grid = make_grid({10, 11, 12}, Centering::node);
    const Volume volume = make_volume<float>(grid, random_samples(grid, random));
    const View view(camera_at(grid, Projection::perspective, {-2, 1, 3}, 0.9), 40, 30);
    std::vector<Judged> result;
    result.push_back({volume, ramp_function(0.4), view});
    result.push_back({volume, ramp_function(20), view});
    result.push_back({volume, random_function(random, 3, 0, 5), view});
    result.push_back({volume, random_function(random, 2, 3, 50), view});
    result.push_back({volume, random_function(random, 1, 1, 0.01), view});
    return result;
}

// The estimate is within the tolerance, and the true error (against a picture with tolerance 1e-12)
// is within the estimate.
TEST(ErrorEstimate, KeepsTheToleranceAndCoversTheError) {
    for (const Judged& scene : scenes()) {
        const TraceResult exact = trace_volume(scene.volume, scene.function, scene.view, {1e-12});
        for (const double tolerance : {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9}) {
            const TraceResult result =
                trace_volume(scene.volume, scene.function, scene.view, {tolerance});
            EXPECT_LE(result.error_estimate, tolerance);
            EXPECT_GT(result.error_estimate, 0);
            // 1e-13: rounding, which differs only by the order of sums.
            EXPECT_LE(largest_difference(result.image, exact.image),
                      result.error_estimate + exact.error_estimate + 1e-13)
                << tolerance;
        }
    }
}

TEST(ErrorEstimate, IsZeroWhereEverythingIsExact) {
    Random random(42);
    const Grid grid = make_grid({4, 4, 4}, Centering::node);
    const Volume volume = make_volume<float>(grid, random_samples(grid, random));
    const View view(camera_at(grid, Projection::orthographic, {1, 2, 3}, 1), 16, 16);
    // One colour takes no quadrature, and a thin medium no early termination.
    const TransferFunction one_color =
        TransferFunction::linear({{0, {{1, 0.5, 0}, 0}}, {1, {{1, 0.5, 0}, 0.5}}});
    const TraceResult result = trace_volume(volume, one_color, view, {});
    EXPECT_EQ(result.error_estimate, 0);
    EXPECT_GT(largest_alpha(result.image), 0.1);
}

TEST(ErrorEstimate, IncludesEarlyTermination) {
    const Grid grid = make_grid({400, 2, 2}, Centering::node);
    const Volume volume = make_volume<std::uint8_t>(grid, std::vector<std::uint8_t>(1600, 1));
    Camera camera = camera_at(grid, Projection::orthographic, {1, 0, 0}, 1);
    camera.height = 0.1;
    const TraceResult result =
        trace_volume(volume, constant_function(1, glm::dvec3(2)), View(camera, 1, 1), {1e-5});
    EXPECT_LT(result.segments, 30);  // ends at a depth of some 20: exp(-20) is 2e-9
    const double left_out = 2 * (1 - result.image.rgba[3]);
    EXPECT_GT(left_out, 0);
    EXPECT_NEAR(result.error_estimate, left_out, 1e-15);
    EXPECT_LE(result.error_estimate, 1e-5);
}

TEST(ErrorEstimate, ToleranceOutOfRangeIsAnError) {
    const Judged scene = scenes().front();
    for (const double tolerance : {0.0, -1.0, 1e-13, 2.0, std::nan("")}) {
        EXPECT_THROW(trace_volume(scene.volume, scene.function, scene.view, {tolerance}), Error);
    }
}

}  // namespace
}  // namespace lamina
