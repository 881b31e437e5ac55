// SPDX-License-Identifier: Apache-2.0
#include "optics/opacity.h"

#include <gtest/gtest.h>

#include <cmath>

#include "optics/colormap.h"
#include "support/expect_error.h"

namespace lamina {
namespace {

constexpr double below = -1e-9, above = 1e-9;  // distances of scalars just beside a point

double extinction_at(const TransferFunction& f, double value) {
    return f.at(value).extinction;
}

// Expects the extinction -log1p(-opacity) / unit_length, to opacity_slope_tolerance; rounding adds
// 1e-10 at most (see opacity_slope_test.cpp).
void expect_curve(const TransferFunction& f, double value, double opacity, double unit_length) {
    const double wanted = -std::log1p(-opacity) / unit_length;
    EXPECT_NEAR(extinction_at(f, value), wanted, wanted * (opacity_slope_tolerance + 1e-10))
        << value;
}

TEST(GivenPoints, OpacityIsLinearBetweenPoints) {
    for (const double unit_length : {1.0, .25, 40.0}) {
        const auto f = TransferFunction::linear_opacity(
            {{10, {1, 0, 0}, 0}, {60, {0, 1, 0}, .8}, {100, {0, 0, 1}, .2}}, unit_length);
        for (double share = 0; share <= 1; share += 1 / 512.0) {
            expect_curve(f, 10 + 50 * share, .8 * share, unit_length);
            expect_curve(f, 60 + 40 * share, .8 - .6 * share, unit_length);
            const glm::dvec3 color = f.at(10 + 50 * share).color;
            EXPECT_NEAR(color.r, 1 - share, 1e-14);
            EXPECT_NEAR(color.g, share, 1e-14);
        }
        EXPECT_EQ(extinction_at(f, 0), 0);
        EXPECT_EQ(extinction_at(f, 60), extinction_from_opacity(.8, unit_length));
        EXPECT_EQ(extinction_at(f, 200), extinction_from_opacity(.2, unit_length));
    }
}

TEST(GivenPoints, ASlopeToOneEndsAtTheSteepestDepthAndIsOpaqueBeyond) {
    const double unit_length = .5;
    const auto f =
        TransferFunction::linear_opacity({{0, {1, 1, 1}, 0}, {1, {1, 1, 1}, 1}}, unit_length);
    for (double clear = 1; clear > 1e-7; clear /= 1.25)
        expect_curve(f, 1 - clear, 1 - clear, unit_length);
    EXPECT_EQ(extinction_at(f, 1 - 1e-15), steepest_optical_depth / unit_length);
    EXPECT_EQ(extinction_at(f, 1 + 1e-15), opaque_optical_depth / unit_length);
    // The colour is the same everywhere, and only the step at the end exceeds
    // steepest_optical_depth.
    EXPECT_TRUE(f.single_color(-1, 2));
    EXPECT_EQ(f.max_extinction(0, std::nextafter(1, 0)), steepest_optical_depth / unit_length);
}

TEST(GivenPoints, ATentHasNoSpike) {
    const auto f = TransferFunction::linear_opacity(
        {{0, {1, 1, 1}, 0}, {5, {1, 1, 1}, 1}, {9, {1, 1, 1}, 0}}, 1);
    EXPECT_EQ(extinction_at(f, 5), steepest_optical_depth);
    EXPECT_EQ(f.max_extinction(-100, 100), steepest_optical_depth);
}

TEST(GivenPoints, AnIntervalOfOpacityOneIsOpaque) {
    const auto f = TransferFunction::linear_opacity(
        {{0, {1, 1, 1}, 0}, {4, {1, 1, 1}, 1}, {6, {1, 1, 1}, 1}, {9, {1, 1, 1}, 0}}, 2);
    EXPECT_EQ(extinction_at(f, 4 + above), opaque_optical_depth / 2);
    EXPECT_EQ(extinction_at(f, 6 + below), opaque_optical_depth / 2);
    // At 1e-9 beside the points, opacity lacks less of 1 than steepest_optical_depth leaves, 4e-8.
    EXPECT_EQ(extinction_at(f, 4 + below), steepest_optical_depth / 2);
    EXPECT_EQ(extinction_at(f, 6 + above), steepest_optical_depth / 2);
}

TEST(GivenPoints, TwoPointsAtOneValueAreAStep) {
    const auto f = TransferFunction::linear_opacity({{0, {1, 1, 1}, 0},
                                                     {3, {1, 1, 1}, 0},
                                                     {3, {1, 0, 0}, 1},
                                                     {7, {1, 0, 0}, .5},
                                                     {7, {0, 1, 0}, .1}},
                                                    1);
    EXPECT_EQ(f.max_extinction(-5, 3 + below), 0);
    EXPECT_EQ(extinction_at(f, 3), steepest_optical_depth);
    EXPECT_EQ(f.at(3).color, glm::dvec3(1, 0, 0));
    expect_curve(f, 5, .75, 1);
    expect_curve(f, 7 + below, .5 + 1e-9 / 8, 1);
    EXPECT_EQ(extinction_at(f, 7), extinction_from_opacity(.1, 1));
    EXPECT_EQ(f.max_extinction(7 + above, 1e9), extinction_from_opacity(.1, 1));
}

TEST(GivenPoints, OnePointIsConstant) {
    const auto f = TransferFunction::linear_opacity({{3, {1, .5, 0}, 1}}, 2);
    EXPECT_EQ(f.knots().size(), 1u);
    EXPECT_EQ(extinction_at(f, -7), opaque_optical_depth / 2);
    const auto step = TransferFunction::linear_opacity({{3, {1, 1, 1}, 1}, {3, {1, 1, 1}, .5}}, 2);
    EXPECT_EQ(extinction_at(step, 3 + below), opaque_optical_depth / 2);
    EXPECT_EQ(extinction_at(step, 3), std::log(2) / 2);
}

TEST(GivenPoints, ExtinctionIsLinearBesidePointsOfExtinction) {
    using Density = GivenPoint::Density;
    const glm::dvec3 white(1);
    const auto f = TransferFunction::linear(linear_in_opacity({{0, white, Density::extinction, 1},
                                                               {4, white, Density::opacity, .5},
                                                               {8, white, Density::extinction, 0},
                                                               {9, white, Density::opacity, 1},
                                                               {10, white, Density::opacity, 1}},
                                                              2));
    EXPECT_DOUBLE_EQ(extinction_at(f, 2), (1 + std::log(2) / 2) / 2);
    EXPECT_DOUBLE_EQ(extinction_at(f, 6), std::log(2) / 4);
    EXPECT_DOUBLE_EQ(extinction_at(f, 8.5), steepest_optical_depth / 4);
    EXPECT_EQ(extinction_at(f, 9), opaque_optical_depth / 2);
}

TEST(GivenPoints, OpacitiesOfAPresetGiveTheSameFunction) {
    Colormap map;
    map.colors = {{0, glm::dvec3(1, 0, 0)}, {10, glm::dvec3(1, 0, 0)}};
    map.opacities = {{2, 0}, {5, 1}, {5, .25}, {9, .75}};
    const auto preset = TransferFunction::linear(combine(map, .5));
    const auto points = TransferFunction::linear_opacity(
        {{2, {1, 0, 0}, 0}, {5, {1, 0, 0}, 1}, {5, {1, 0, 0}, .25}, {9, {1, 0, 0}, .75}}, .5);
    for (double value = 1; value < 11; value += 1 / 64.0)
        EXPECT_EQ(preset.at(value).color, points.at(value).color) << value;
    for (const TransferKnot& knot : points.knots())
        EXPECT_EQ(preset.at(knot.value), points.at(knot.value)) << knot.value;
    EXPECT_EQ(preset.max_extinction(-9, 20), steepest_optical_depth / .5);
}

TEST(GivenPoints, MistakesAreNamed) {
    const auto make = [](std::vector<OpacityKnot> points, double unit_length) {
        return [=] { TransferFunction::linear_opacity(points, unit_length); };
    };
    expect_error(make({{0, {1, 1, 1}, 1.5}}, 1), {"point 0", "opacity is 1.5", "0 to 1"});
    expect_error(make({{0, {1, 1, 1}, NAN}}, 1), {"point 0", "opacity is nan"});
    expect_error(make({{0, {1, 1, 1}, 0}}, 0), {"unit_length is 0"});
    expect_error(make({}, 1), {"no points"});
    expect_error(make({{1, {1, 1, 1}, 0}, {0, {1, 1, 1}, 1}}, 1), {"point 1", "at least 1"});
    expect_error(make({{1, {1, 1, 1}, 0}, {1, {1, 1, 1}, 1}, {1, {1, 1, 1}, 0}}, 1),
                 {"point 2", "for the third time"});
    std::vector<OpacityKnot> zigzag;
    for (int i = 0; i < 4096; ++i) zigzag.push_back({double(i), {1, 1, 1}, double(i % 2)});
    expect_error(make(zigzag, 1), {"more than 4096 pieces"});
}

}  // namespace
}  // namespace lamina
