// SPDX-License-Identifier: Apache-2.0
#include "model/transfer_editor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "lamina/color.h"
#include "model/opacity_slopes.h"
#include "model/transfer_curves.h"

namespace lamina::view {
namespace {

using Curve = TransferHandle::Curve;

const SymlogAxis axis(0, 10, .01);

TransferKnot knot(double value, const glm::dvec3& color, double extinction) {
    return {value, {color, extinction}, false};
}

TransferEditor editor_of(const TransferFunction& function) {
    TransferEditor editor;
    editor.take(function);
    return editor;
}

// Returns an editor with four points whose numbers are no short binary fractions, so that a
// rounding would show.
TransferEditor four_points() {
    return editor_of(
        TransferFunction::linear({knot(.1, {.1, .9, .3}, .11), knot(1.7, {1, .2, .7}, .7),
                                  knot(3.3, {.3, .3, .1}, .013), knot(4.9, {.2, .6, .5}, 1.9)}));
}

void drag(TransferEditor& editor, const TransferShift& shift) {
    editor.begin_move();
    editor.move(shift, axis);
    editor.end_move();
}

TEST(TransferEditor, DragsOnePointAndNoOther) {
    TransferEditor editor = four_points();
    const TransferCurves before = editor.curves();
    editor.select_only({Curve::density, 1});
    drag(editor, {.25, .1});
    const TransferCurves& after = editor.curves();
    EXPECT_EQ(after.density[1].value, 1.7 + .25);
    EXPECT_EQ(after.density[1].extinction, axis.number(axis.place(.7) + .1));
    // The colour stop at the same value moves along.
    EXPECT_EQ(after.colors[1].value, after.density[1].value);
    EXPECT_EQ(after.colors[1].color, before.colors[1].color);
    for (const std::size_t other : {0u, 2u, 3u}) {
        EXPECT_EQ(after.density[other], before.density[other]);
        EXPECT_EQ(after.colors[other].value, before.colors[other].value);
        EXPECT_EQ(after.colors[other].color, before.colors[other].color);
    }
    EXPECT_EQ(editor.function().knots()[1].value, 1.7 + .25);
}

TEST(TransferEditor, AMoveToWhereItBeganChangesNothing) {
    TransferEditor editor = four_points();
    const TransferCurves before = editor.curves();
    editor.select_all(Curve::density);
    editor.begin_move();
    EXPECT_TRUE(editor.move({.3, -.4}, axis));
    EXPECT_FALSE(editor.curves() == before);
    EXPECT_TRUE(editor.move({0, 0}, axis));
    EXPECT_TRUE(editor.curves() == before);
    editor.move({1, 1}, axis);
    editor.cancel_move();
    EXPECT_TRUE(editor.curves() == before);
    EXPECT_FALSE(editor.is_moving());
}

TEST(TransferEditor, PointsDoNotPassEachOther) {
    TransferEditor editor = four_points();
    editor.select_only({Curve::density, 1});
    drag(editor, {100, 0});
    // The point reaches the value of the next one and makes a step. Two points are a step; a third
    // stops below that value.
    EXPECT_EQ(editor.curves().density[1].value, 3.3);
    editor.select_only({Curve::density, 0});
    drag(editor, {100, 0});
    EXPECT_LT(editor.curves().density[0].value, 3.3);
    EXPECT_GT(editor.curves().density[0].value, 3.2999);
    // Extinction stays within the axis, 0 to 10.
    editor.select_all(Curve::density);
    drag(editor, {0, -100});
    for (const DensityPoint& point : editor.curves().density) EXPECT_EQ(point.extinction, 0);
    drag(editor, {0, 100});
    for (const DensityPoint& point : editor.curves().density) EXPECT_EQ(point.extinction, 10);
}

TEST(TransferEditor, SeveralPointsKeepTheirDistances) {
    TransferEditor editor = four_points();
    editor.select_only({Curve::density, 1});
    editor.toggle({Curve::density, 2});
    drag(editor, {-100, 0});
    EXPECT_EQ(editor.curves().density[1].value, .1);
    EXPECT_NEAR(editor.curves().density[2].value, .1 + 1.6, 1e-15);  // rounding of numbers below 4
}

TEST(TransferEditor, MakesAndMovesSteps) {
    TransferEditor editor = four_points();
    EXPECT_TRUE(editor.make_step({Curve::density, 1}));
    EXPECT_EQ(editor.curves().density.size(), 5u);
    EXPECT_EQ(editor.curves().density[2].value, 1.7);
    EXPECT_FALSE(editor.make_step({Curve::density, 1}));  // there are two points already
    EXPECT_TRUE(editor.set_extinction(2, 5));
    EXPECT_EQ(editor.function().at(1.7).extinction, 5);
    EXPECT_LT(editor.function().at(1.6999).extinction, 1);
    editor.select_only({Curve::density, 1});
    editor.toggle({Curve::density, 2});
    drag(editor, {100, 0});
    // Both points of the step move together, and stop just below the next point.
    EXPECT_EQ(editor.curves().density[1].value, editor.curves().density[2].value);
    EXPECT_LT(editor.curves().density[2].value, 3.3);
}

TEST(TransferEditor, AddsAndRemovesPoints) {
    TransferEditor editor = four_points();
    const TransferCurves before = editor.curves();
    EXPECT_TRUE(editor.add_density(2.5, .4));
    EXPECT_TRUE(editor.is_selected({Curve::density, 2}));
    EXPECT_EQ(editor.curves().density[2].value, 2.5);
    EXPECT_EQ(editor.function().at(2.5).extinction, .4);
    EXPECT_TRUE(editor.remove_selected());
    EXPECT_TRUE(editor.curves() == before);
    EXPECT_FALSE(editor.remove_selected());  // nothing is selected
    editor.select_all(Curve::density);
    editor.select_all(Curve::color);
    EXPECT_TRUE(editor.remove_selected());
    EXPECT_EQ(editor.curves().density.size(), 1u);
    EXPECT_EQ(editor.curves().colors.size(), 1u);
}

TEST(TransferEditor, SelectsRectangles) {
    TransferEditor editor = four_points();
    editor.select_within(0, 3.3, .1, 1);
    EXPECT_EQ(editor.selection(),
              (std::set<TransferHandle>{{Curve::density, 0}, {Curve::density, 1}}));
    editor.select_within(4, 5, 0, 5);
    EXPECT_EQ(editor.selection().size(), 3u);
}

TEST(TransferEditor, InvalidInputChangesNothing) {
    TransferEditor editor = four_points();
    const TransferCurves before = editor.curves();
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    constexpr double endless = std::numeric_limits<double>::infinity();
    for (const double bad : {-1., none, endless}) {
        EXPECT_FALSE(editor.set_extinction(0, bad));
        EXPECT_FALSE(editor.add_density(2, bad));
        EXPECT_FALSE(editor.set_color(0, glm::dvec3(bad)));
    }
    EXPECT_FALSE(editor.set_value({Curve::density, 0}, none));
    EXPECT_FALSE(editor.set_opacity(0, 1.1));
    editor.begin_move();
    EXPECT_FALSE(editor.attenuate(0));
    EXPECT_FALSE(editor.window(0, 1, 1));
    editor.end_move();
    EXPECT_FALSE(editor.attenuate(2));  // no move was begun
    EXPECT_FALSE(editor.set_extinction(99, 1));
    EXPECT_TRUE(editor.curves() == before);
    // Typed values stay between their neighbours.
    EXPECT_TRUE(editor.set_value({Curve::density, 1}, 1e6));
    EXPECT_EQ(editor.curves().density[1].value, 3.3);
}

TEST(TransferEditor, RandomDragsLeaveAValidFunction) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(-1, 1);
    TransferEditor editor = four_points();
    int refused = 0;
    for (int i = 0; i < 3000; ++i) {
        const auto& density = editor.curves().density;
        const auto any = static_cast<std::size_t>((uniform(random) + 1) / 2 *
                                                  static_cast<double>(density.size()));
        if (i % 7 == 0) editor.add_density(5 * uniform(random), 1 + uniform(random));
        if (i % 11 == 0) editor.make_step({Curve::density, std::min(any, density.size() - 1)});
        if (density.size() > 12) editor.remove_selected();
        if (i % 3 == 0) editor.clear_selection();
        editor.toggle({Curve::density, std::min(any, density.size() - 1)});
        editor.begin_move();
        const TransferCurves before = editor.curves();
        // Points a rounding apart may come to be three at one value: then the move is refused.
        if (!editor.move({4 * uniform(random), uniform(random)}, axis)) {
            ++refused;
            EXPECT_TRUE(editor.curves() == before);
        }
        editor.end_move();
        editor.set_opacity_linear(i % 5 == 0);
    }
    EXPECT_LT(refused, 30);
    TransferEditor again;
    again.take(editor.function());
    EXPECT_TRUE(again.function() == editor.function());
}

TEST(TransferEditor, ASlopeOfOpacityFollowsItsEnds) {
    TransferEditor editor = editor_of(TransferFunction::linear_opacity(
        {{0, {1, 0, 0}, 0}, {10, {1, 1, 0}, .9}, {20, {0, 1, 1}, .2}}, 1));
    ASSERT_EQ(editor.curves().density.size(), 3u);
    const std::vector<ExtinctionKnot> second = editor.curves().density[1].inside;
    editor.select_only({Curve::density, 0});
    drag(editor, {2, .3});
    // Moving its first point leaves the slope from the second to the third alone.
    EXPECT_EQ(editor.curves().density[1].inside, second);
    const DensityPoint& from = editor.curves().density[0];
    const double opacity = opacity_of(from.extinction, 1);
    for (double share = .05; share < 1; share += .1) {
        const double value = from.value + share * (10 - from.value);
        const double wanted = -std::log1p(-((1 - share) * opacity + share * .9));
        // Pieces follow opacities within 7.8e-4 of the extinction (docs/scene.md, "Opacity").
        EXPECT_NEAR(editor.function().at(value).extinction, wanted, 7.9e-4 * wanted);
    }
}

// docs/scene.md, "Opacity": 17 / unit_length beside a slope, 1e7 / unit_length elsewhere.
TEST(TransferEditor, OpacityOneIsAStepBesideASlope) {
    TransferEditor editor =
        editor_of(TransferFunction::linear({knot(0, {1, 1, 1}, 0), knot(4, {1, 1, 1}, 1)}));
    editor.set_unit_length(2);
    EXPECT_TRUE(editor.set_opacity(1, 1));
    EXPECT_EQ(editor.curves().density[1].extinction, 1e7 / 2);
    EXPECT_TRUE(editor.set_opacity_linear(true));
    const auto expected =
        TransferFunction::linear_opacity({{0, {1, 1, 1}, 0}, {4, {1, 1, 1}, 1}}, 2);
    EXPECT_TRUE(editor.function() == expected);
    // A peak of opacity 1 between two slopes is a single point.
    EXPECT_TRUE(editor.add_density(9, 0));
    const auto peak = TransferFunction::linear_opacity(
        {{0, {1, 1, 1}, 0}, {4, {1, 1, 1}, 1}, {9, {1, 1, 1}, 0}}, 2);
    editor.clear_selection();
    EXPECT_TRUE(editor.set_opacity_linear(true));
    EXPECT_TRUE(editor.function() == peak);
}

TEST(TransferEditor, WindowAndLevelMoveAllValues) {
    TransferEditor editor = four_points();
    editor.begin_move();
    EXPECT_TRUE(editor.window(2, 1.7, .5));
    editor.end_move();
    EXPECT_EQ(editor.curves().density[1].value, 1.7 + .5);
    EXPECT_EQ(editor.curves().density[2].value, 1.7 + 2 * (3.3 - 1.7) + .5);
    EXPECT_EQ(editor.curves().colors[2].value, editor.curves().density[2].value);
    EXPECT_EQ(editor.curves().density[2].extinction, .013);
}

TEST(TransferEditor, DensityScalesAllExtinctionsAndKeepsSlopes) {
    const TransferFunction function =
        TransferFunction::linear_opacity({{0, {1, 0, 0}, 0}, {10, {1, 1, 0}, .9}}, 1);
    TransferEditor editor = editor_of(function);
    editor.begin_move();
    EXPECT_TRUE(editor.attenuate(3));
    EXPECT_TRUE(editor.attenuate(4));  // both factors are relative to the start of the move
    editor.end_move();
    EXPECT_TRUE(editor.function() == function.attenuated(4));
    EXPECT_EQ(editor.curves().density.size(), 2u);
    EXPECT_NEAR(editor.curves().density[0].opacity_length, .25, 1e-16);
}

TEST(TransferEditor, MapsReplaceColorsAlone) {
    TransferEditor editor = four_points();
    const auto density = editor.curves().density;
    EXPECT_TRUE(editor.recolor(load_colormap("viridis"), 0, 5, true));
    EXPECT_EQ(editor.curves().density, density);
    EXPECT_EQ(editor.curves().colors.front().value, 0);
    EXPECT_EQ(editor.curves().colors.back().value, 5);
    EXPECT_FALSE(editor.recolor(load_colormap("viridis"), 5, 5, true));
    EXPECT_TRUE(editor.recolor(load_colormap("ct-bone"), 0, 5, false));
    EXPECT_EQ(editor.curves().density, density);
    EXPECT_TRUE(editor.recolor(load_colormap("ct-bone"), 0, 5, true));
    EXPECT_NE(editor.curves().density, density);
}

TEST(TransferEditor, ShapesReplaceExtinctionAlone) {
    TransferEditor editor = four_points();
    const glm::dvec3 color = editor.function().at(1.7).color;
    EXPECT_TRUE(editor.set_density(ramp_shape(-1, 9, 2)));
    EXPECT_EQ(editor.function().at(4).extinction, 1);
    EXPECT_EQ(editor.function().at(1.7).color, color);
    EXPECT_TRUE(editor.set_density(peak_shape(0, 40, 10, 3)));
    EXPECT_EQ(editor.function().at(10).extinction, 3);
    EXPECT_EQ(editor.function().at(9).extinction, 0);
    EXPECT_TRUE(editor.set_density(step_shape(0, 40, 10, 3)));
    EXPECT_EQ(editor.function().at(9.99).extinction, 0);
    EXPECT_EQ(editor.function().at(10).extinction, 3);
    EXPECT_FALSE(editor.set_density({}));
}

TEST(TransferEditor, PalettesStepHalfwayBetweenPoints) {
    TransferEditor editor =
        editor_of(TransferFunction::linear({knot(0, {1, 0, 0}, .5), knot(2, {0, 1, 0}, 1)}));
    EXPECT_TRUE(editor.set_palette(true));
    EXPECT_EQ(editor.function().at(.99).color, glm::dvec3(1, 0, 0));
    EXPECT_EQ(editor.function().at(1.01).extinction, 1);
    EXPECT_TRUE(editor.set_palette(false));
    EXPECT_EQ(editor.function().at(1).extinction, .75);
}

TEST(TransferEditor, ConvertsColorsToAnotherSpace) {
    TransferEditor editor = four_points();
    const glm::dvec3 color = editor.curves().colors[1].color;
    EXPECT_TRUE(editor.convert_colors(ImageColorSpace::linear, ImageColorSpace::display));
    EXPECT_EQ(editor.curves().colors[1].color, display_of_color(color));
}

}  // namespace
}  // namespace lamina::view
