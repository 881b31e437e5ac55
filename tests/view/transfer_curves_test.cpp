// SPDX-License-Identifier: Apache-2.0
#include "model/transfer_curves.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "lamina/color.h"
#include "lamina/error.h"
#include "lamina/scene.h"

namespace lamina::view {
namespace {

TransferFunction of_scene(const std::string& transfer_function) {
    return *parse_scene(R"({"version": 1, "volume": {"generate": "ramp"}, "transfer_function": )" +
                            transfer_function + "}",
                        "scene")
                .transfer_function;
}

void expect_round_trip(const TransferFunction& function) {
    EXPECT_TRUE(curves_of(function, 1).function() == function);
}

TEST(TransferCurves, GiveTheFunctionBackBitForBit) {
    expect_round_trip(TransferFunction::linear({TransferKnot{}}));
    expect_round_trip(of_scene(R"({"points": [{"value": 28, "color": "tomato", "extinction": 0},
                                              {"value": 255, "extinction": 0.6}]})"));
    // Steps of extinction or of colour, and palettes.
    expect_round_trip(of_scene(
        R"({"points": [{"value": 0, "extinction": 0.1}, {"value": 1, "extinction": 0.3},
            {"value": 1, "extinction": 0.7}, {"value": 2, "color": "red", "extinction": 0.7},
            {"value": 2, "color": "blue", "extinction": 0.7}]})"));
    expect_round_trip(of_scene(
        R"({"interpolation": "nearest", "points": [{"value": 0.1, "color": "red", "opacity": 0.1},
            {"value": 0.3, "color": "blue", "opacity": 0}, {"value": 0.35, "opacity": 0.9}]})"));
}

TEST(TransferCurves, GiveMapsWithOpacitiesBack) {
    for (const std::string& name : colormap_names()) {
        expect_round_trip(of_scene(R"({"colormap": ")" + name + R"(", "colormap_range": [3, 200],
            "points": [{"value": 10, "opacity": 0}, {"value": 50, "opacity": 0.95},
                       {"value": 120, "opacity": 0.95}, {"value": 121, "extinction": 0.01}]})"));
    }
    expect_round_trip(of_scene(R"({"colormap": "ct-bone"})"));
}

TEST(TransferCurves, GiveRandomFunctionsBack) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (int round = 0; round < 200; ++round) {
        std::vector<TransferKnot> knots;
        double value = -1;
        const auto color = [&] { return glm::dvec3(uniform(random), .5, round % 3 == 0); };
        for (int i = 0; i < 12; ++i) {
            const bool step =
                i > 1 && uniform(random) < .2 && knots[knots.size() - 2].value < value;
            if (!step) value += uniform(random) < .5 ? .25 : uniform(random);
            const double extinction = uniform(random) < .4 ? .5 : uniform(random);
            knots.push_back({value, {color(), extinction}, uniform(random) < .1});
        }
        expect_round_trip(TransferFunction::linear(knots));
    }
}

TEST(TransferCurves, KeepTheFewPointsOfExtinctionBesideAMapOfMany) {
    const TransferFunction function = of_scene(
        R"({"colormap": "viridis", "colormap_range": [0, 255],
            "points": [{"value": 20, "extinction": 0}, {"value": 90, "extinction": 0.123},
                       {"value": 230, "extinction": 0.77}]})");
    const TransferCurves curves = curves_of(function, 1);
    ASSERT_EQ(curves.density.size(), 3u);
    EXPECT_EQ(curves.density[1].value, 90);
    EXPECT_EQ(curves.density[1].extinction, .123);
    EXPECT_GT(curves.colors.size(), 5u);
}

TEST(TransferCurves, FindSlopesOfOpacity) {
    for (const double length : {1., .37, 250.}) {
        const TransferFunction function = TransferFunction::linear_opacity(
            {{0, {1, 0, 0}, 0}, {10, {1, 1, 0}, .97}, {20, {0, 1, 1}, .97}, {35, {0, 0, 1}, .3}},
            length);
        EXPECT_GT(function.knots().size(), 20u);
        const TransferCurves curves = curves_of(function, 1);
        ASSERT_EQ(curves.density.size(), 4u) << length;
        EXPECT_EQ(curves.colors.size(), 4u);
        EXPECT_EQ(curves.density[1].value, 10);
        EXPECT_TRUE(curves.density[1].inside.empty());
        // Lengths are found as numbers of few digits.
        EXPECT_DOUBLE_EQ(curves.density[0].opacity_length, length);
        EXPECT_DOUBLE_EQ(curves.density[2].opacity_length, length);
        EXPECT_TRUE(curves.function() == function);
    }
    // If the length that the editor shows opacities for fits a slope, it is chosen.
    const TransferFunction function =
        TransferFunction::linear_opacity({{0, {1, 0, 0}, 0}, {10, {1, 1, 0}, .97}}, .37);
    EXPECT_EQ(curves_of(function, .37).density[0].opacity_length, .37);
}

TEST(TransferCurves, FindSlopesFromAndToOpacityOne) {
    const TransferFunction function = TransferFunction::linear_opacity(
        {{0, {1, 1, 1}, .1}, {10, {1, 1, 1}, 1}, {20, {1, 1, 1}, 1}, {35, {1, 1, 1}, .3}}, 10);
    const TransferCurves curves = curves_of(function, 1);
    ASSERT_EQ(curves.density.size(), 4u);
    EXPECT_DOUBLE_EQ(curves.density[0].opacity_length, 10);
    EXPECT_DOUBLE_EQ(curves.density[1].extinction, 1e6);
    EXPECT_DOUBLE_EQ(curves.density[2].opacity_length, 10);
    EXPECT_TRUE(curves.function() == function);
}

// A slope of opacity is stored as many points, whose colours were rounded when it was made. They
// are kept bit for bit until a colour stop changes.
TEST(TransferCurves, KeepColorsBetweenStopsUntilAStopChanges) {
    const TransferFunction function = TransferFunction::linear_opacity(
        {{0, {.1, .2, .7}, 0}, {10, {.9, .3, 0}, .97}, {11.3, {.2, .2, .2}, .1}}, 1);
    TransferCurves curves = curves_of(function, 1);
    EXPECT_FALSE(curves.kept.empty());
    EXPECT_TRUE(curves.function() == function);
    curves.colors[0].color = {.3, .2, .7};
    const TransferFunction changed = curves.function();
    const TransferKnot knot = changed.knots()[1];
    EXPECT_EQ(knot.optics.color, color_at(curves.colors, knot.value).above);
    EXPECT_NE(knot.optics.color, function.knots()[1].optics.color);
}

TEST(TransferCurves, SmoothPointsThatFollowNoOpacityStayPoints) {
    std::vector<TransferKnot> knots;
    for (int i = 0; i <= 10; ++i)
        knots.push_back({1. * i, {glm::dvec3(1), i % 2 == 0 ? .2 : .5}, true});
    EXPECT_EQ(curves_of(TransferFunction::linear(knots), 1).density.size(), 11u);
}

TEST(TransferCurves, RefuseWhatIsNoFunction) {
    TransferCurves curves;
    curves.density = {{1, .5, false, 0, {}}, {0, .5, false, 0, {}}};
    EXPECT_THROW((void)curves.function(), Error);
    curves.density = {{1, .5, false, 0, {}}, {1, .2, false, 0, {}}, {1, .1, false, 0, {}}};
    EXPECT_THROW((void)curves.function(), Error);
    curves.density = {};
    EXPECT_THROW((void)curves.function(), Error);
    curves.density = {{0, -1, false, 0, {}}};
    EXPECT_THROW((void)curves.function(), Error);
}

}  // namespace
}  // namespace lamina::view
