// SPDX-License-Identifier: Apache-2.0
#include "optics/table_error.h"

#include <gtest/gtest.h>

#include <cmath>

#include "optics/opacity.h"
#include "optics/segment_table.h"

namespace lamina {
namespace {

TransferFunction ramp(double brightness) {
    return TransferFunction::linear({{0, {glm::dvec3(brightness, 0, 0), 0}},
                                     {.4, {glm::dvec3(0, brightness, 0), 1}},
                                     {1, {glm::dvec3(0, 0, brightness), 2}}});
}

constexpr TableRays rays{0, 1, .01, 1, 16};

TEST(TableError, IsNoneForTheIntegralItself) {
    const TransferFunction f = ramp(1);
    const double error = table_error(f, rays, [&](double front, double back, double length) {
        return integrate_segment(f, front, back, length);
    });
    // What lies behind transmittance 1e-7 is left out, and 1024 roundings.
    EXPECT_LE(error, 255 * 1.1e-7);
}

TEST(TableError, IsThatOfAKnownMistake) {
    // A single segment whose opacity is off by .01, and no ray may hide it.
    const TransferFunction f = ramp(1);
    const auto short_rays = TableRays{0, 1, 1, 1, 1};
    const double error = table_error(f, short_rays, [&](double front, double back, double length) {
        SegmentIntegral found = integrate_segment(f, front, back, length);
        found.alpha += .01;
        return found;
    });
    EXPECT_NEAR(error, 2.55, 1e-9);
}

TEST(TableError, CountsAgainstTheLargestColor) {
    for (const double brightness : {.5, 1.0, 8.0}) {
        const TransferFunction f = ramp(brightness);
        const auto short_rays = TableRays{0, 1, 1, 1, 1};
        const double error =
            table_error(f, short_rays, [&](double front, double back, double length) {
                SegmentIntegral found = integrate_segment(f, front, back, length);
                found.color.g += .01 * brightness;
                return found;
            });
        EXPECT_NEAR(error, 2.55 * std::min(1.0, brightness), 1e-9);
    }
}

TEST(TableError, SeesAPeakBetweenNodes) {
    const auto peak = TransferFunction::linear(
        {{.25, {glm::dvec3(1), 0}}, {.375, {glm::dvec3(1), 40}}, {.5, {glm::dvec3(1), 0}}});
    const auto error_with = [&](int nodes) {
        SegmentTableRequest request;
        request.scalar_nodes = nodes;
        request.format = TableFormat::float32;
        request.colored = false;
        const SegmentTable table = build_segment_table(peak, request);
        return table_error(peak, rays, [&](double front, double back, double length) {
            return table.lookup(front, back, length);
        });
    };
    // Rays that stay at .25, where nothing is: between two nodes the table has up to 320 / 2 / 4
    // times their distance there, over a length of 16.
    EXPECT_GT(error_with(100), 20);
    EXPECT_LT(error_with(1025), 20);
    EXPECT_LT(error_with(1025), error_with(1024) / 2);  // the peak's ends are nodes
}

TEST(TableError, IsTheSameEveryTime) {
    const TransferFunction f = ramp(1);
    const SegmentTable table = build_segment_table(f, {.scalar_nodes = 16, .length_layers = 3});
    const auto lookup = [&](double front, double back, double length) {
        return table.lookup(front, back, length);
    };
    const double error = table_error(f, rays, lookup);
    EXPECT_GT(error, 0);
    EXPECT_EQ(table_error(f, rays, lookup), error);
    // No scalars to run over: homogeneous rays.
    EXPECT_LT(table_error(f, {1, 1, .01, 1, 16}, lookup), 1);
}

}  // namespace
}  // namespace lamina
