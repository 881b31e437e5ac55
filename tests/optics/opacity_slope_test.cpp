// SPDX-License-Identifier: Apache-2.0
#include "optics/opacity.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace lamina {
namespace {

double curve(double opacity) {
    return opacity < 1 ? std::min(-std::log1p(-opacity), steepest_optical_depth)
                       : steepest_optical_depth;
}

std::vector<OpacitySlopeKnot> with_ends(double from, double to) {
    std::vector<OpacitySlopeKnot> knots = follow_opacity(from, to);
    knots.insert(knots.begin(), {0, curve(from)});
    knots.push_back({1, curve(to)});
    return knots;
}

// Returns the lowest and the highest error of a piece, as shares of the curve's own value.
std::pair<double, double> errors_of(double from, double to, const OpacitySlopeKnot& a,
                                    const OpacitySlopeKnot& b) {
    constexpr int places = 400;
    std::pair<double, double> errors{0, 0};
    for (int i = 0; i <= places; ++i) {
        const double way = static_cast<double>(i) / places;
        const double share = a.share + way * (b.share - a.share);
        const double wanted = curve(from + share * (to - from));
        const double found = a.optical_depth + way * (b.optical_depth - a.optical_depth);
        const double error = wanted > 0 ? found / wanted - 1 : found;
        errors = {std::min(errors.first, error), std::max(errors.second, error)};
    }
    return errors;
}

const std::pair<double, double> slopes[] = {
    {0, 1},     {1, 0},        {0, .5},     {.9, 0},  {0, .1},        {.1, .9}, {.5, .5001},
    {1e-9, .3}, {0, 1e-12},    {0, 1e-300}, {.99, 1}, {1 - 1e-9, .2}, {0, .01}, {.003, 0},
    {1, .9999}, {1 - 1e-9, 1}, {1e-300, 1}, {.7, .7}, {0, 1 - 1e-16}};

TEST(OpacitySlope, IsWithinItsToleranceEverywhere) {
    for (const auto& [from, to] : slopes) {
        const auto knots = with_ends(from, to);
        for (std::size_t i = 1; i < knots.size(); ++i) {
            const auto [low, high] = errors_of(from, to, knots[i - 1], knots[i]);
            // Rounding: near 1, opacity has an error of 2^-54, relative to 1 - opacity of at least
            // 4e-8; divided by the depth of 17 this makes 1e-10.
            EXPECT_GE(low, -opacity_slope_tolerance - 1e-10) << from << " " << to << " piece " << i;
            EXPECT_LE(high, opacity_slope_tolerance + 1e-10) << from << " " << to << " piece " << i;
        }
    }
}

TEST(OpacitySlope, KnotsAscendInsideTheSlope) {
    for (const auto& [from, to] : slopes) {
        const auto knots = with_ends(from, to);
        for (std::size_t i = 1; i < knots.size(); ++i) {
            EXPECT_GT(knots[i].share, knots[i - 1].share) << from << " " << to;
            const double rise = knots[i].optical_depth - knots[i - 1].optical_depth;
            EXPECT_GE(to < from ? -rise : rise, 0) << from << " " << to;
        }
    }
}

// A piece from opacity o on can have a length h with f'' h^2 / 8 = 2 e f, since it may be off by e
// f on both sides; f'' = 1 / (1 - o)^2. The number of pieces is the integral of do / h = df / (4
// sqrt(e f)), that is (sqrt(f1) - sqrt(f0)) / (2 sqrt(e)). Short slopes, and those from 0, differ:
// both ends are on the curve itself, where a piece is up to sqrt(2) times shorter, and near 0 the
// tolerance permits an o of 4 e. Together this makes less than 2 pieces.
TEST(OpacitySlope, HasAsManyPiecesAsTheToleranceTakes) {
    for (const auto& [from, to] : slopes) {
        const double wanted = std::abs(std::sqrt(curve(to)) - std::sqrt(curve(from))) /
                              (2 * std::sqrt(opacity_slope_tolerance));
        const double pieces = static_cast<double>(follow_opacity(from, to).size()) + 1;
        EXPECT_LE(pieces, wanted + 3) << from << " " << to;  // one more at steepest_optical_depth
        EXPECT_GE(pieces, std::floor(wanted)) << from << " " << to;
    }
}

// All pieces but the first and the last, whose ends are on the curve, rise as far above the curve
// as they fall below it, and as far as the other pieces.
TEST(OpacitySlope, PiecesShareTheError) {
    const auto knots = with_ends(.05, .95);
    ASSERT_GT(knots.size(), 10u);
    const double all = errors_of(.05, .95, knots[2], knots[3]).second;
    for (std::size_t i = 2; i + 1 < knots.size(); ++i) {
        const auto [low, high] = errors_of(.05, .95, knots[i - 1], knots[i]);
        // The error of a piece is nearly a parabola from -e over e to -e. Its top lies up to 1/800
        // from a sampled place, so 2 (2/800)^2 = 1.25e-5 of e are missed; twice that for the cubic
        // part.
        EXPECT_NEAR(high, all, 2.5e-5 * all) << i;
        EXPECT_NEAR(-low, all, 2.5e-5 * all) << i;
    }
}

TEST(OpacitySlope, IsTheSameBothWays) {
    const auto up = follow_opacity(.2, .8), down = follow_opacity(.8, .2);
    ASSERT_EQ(up.size(), down.size());
    for (std::size_t i = 0; i < up.size(); ++i) {
        EXPECT_EQ(up[i].optical_depth, down[up.size() - 1 - i].optical_depth);
        // 1 - (1 - x) rounds once, to 2^-54.
        EXPECT_NEAR(up[i].share, 1 - down[up.size() - 1 - i].share, 0x1p-54);
    }
}

TEST(OpacitySlope, FlatAndNearlyStraightSlopesHaveNoKnots) {
    EXPECT_TRUE(follow_opacity(.3, .3).empty());
    EXPECT_TRUE(follow_opacity(1, 1).empty());
    EXPECT_TRUE(follow_opacity(1 - 1e-9, 1).empty());  // all of it is at the steepest depth
    // A straight line is off by only o / 2 of the curve.
    EXPECT_TRUE(follow_opacity(0, 1e-4).empty());
}

}  // namespace
}  // namespace lamina
