// SPDX-License-Identifier: Apache-2.0
#include "annotation/canvas.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace lamina {
namespace {

constexpr Paint white{glm::dvec3(1)};

// Returns the opacity of a layer, summed over pixels: the area of what was filled.
double area_of(const Image& layer) {
    double area = 0;
    for (std::size_t i = 3; i < layer.rgba.size(); i += 4) area += layer.rgba[i];
    return area;
}

std::shared_ptr<const Image> filled(const Outline& path, ImageColorSpace space = {}) {
    Canvas canvas(32, 24, space);
    canvas.fill(path, white);
    return canvas.take();
}

// Sums of 32-bit opacities: 24 * 32 roundings of at most 2^-25 each.
constexpr double rounding = 768 * 0x1p-25;

TEST(Canvas, CoversAPixelByTheAreaOfARectangleInIt) {
    const auto layer = filled(outline_of({3.25, 2.5, 4.5, 3}));
    EXPECT_FLOAT_EQ(layer->pixel(3, 2)[3], 0.75f * 0.5f);
    EXPECT_EQ(layer->pixel(4, 3)[3], 1);
    EXPECT_FLOAT_EQ(layer->pixel(7, 3)[3], 0.75f);
    EXPECT_EQ(layer->pixel(8, 3)[3], 0);
    EXPECT_NEAR(area_of(*layer), 4.5 * 3, rounding);
}

TEST(Canvas, CoversTheAreaOfATriangle) {
    Outline path;
    path.move_to({1.3, 2.1});
    path.line_to({28.9, 7.7});
    path.line_to({9.2, 21.4});
    const double area = 0.5 * std::abs((28.9 - 1.3) * (21.4 - 2.1) - (9.2 - 1.3) * (7.7 - 2.1));
    EXPECT_NEAR(area_of(*filled(path)), area, rounding);
}

TEST(Canvas, CutsOffWhatLiesOutside) {
    const auto layer = filled(outline_of({-5, -5, 8.5, 100}));
    EXPECT_NEAR(area_of(*layer), 3.5 * 24, rounding);
    EXPECT_EQ(layer->pixel(0, 0)[3], 1);
    EXPECT_EQ(area_of(*filled(outline_of({40, 3, 5, 5}))), 0);
    EXPECT_EQ(area_of(*filled(outline_of({-40, 3, 5, 5}))), 0);
    EXPECT_NEAR(area_of(*filled(outline_of({-1e6, 3, 2e6, 5}))), 32 * 5, rounding);
}

TEST(Canvas, ContoursTheOtherWayRoundAreHoles) {
    Outline path = outline_of({2, 2, 10, 10});
    path.move_to({4, 4});
    path.line_to({10, 4});
    path.line_to({10, 10});
    path.line_to({4, 10});
    const auto layer = filled(path);
    EXPECT_NEAR(area_of(*layer), 100 - 36, rounding);
    EXPECT_EQ(layer->pixel(6, 6)[3], 0);
}

// Curves and circle share the tangents at the middles of the octagon's edges. Farthest out is a
// curve's middle, half of the corner and half of the chord: (1 / cos(pi / 8) + cos(pi / 8)) / 2 of
// the radius, 1.0031. Lines instead of curves lie up to .02 pixels farther in, .0022 of the radius.
TEST(Canvas, ADiskHasItsArea) {
    const double radius = 9.3;
    const double area = std::numbers::pi * radius * radius;
    EXPECT_NEAR(area_of(*filled(disk_outline({15.2, 11.9}, radius))), area, 0.012 * area);
}

TEST(Canvas, ALineHasItsLengthAndThickness) {
    const auto layer = filled(line_outline({3, 4}, {23, 19}, 1.5));
    EXPECT_NEAR(area_of(*layer), 25 * 1.5, rounding);  // 20, 15, 25 are a right triangle's
}

// A dot above the shape moves the rows at which its parts meet.
TEST(Canvas, FillsTallShapesWithoutSeams) {
    const auto fill = [](double dot) {
        Outline path;
        path.move_to({5.3, 9.1});
        path.line_to({290.7, 120.9});  // beyond the right end
        path.line_to({13.2, 391.4});
        if (dot > 0) {
            path.move_to({1, dot});
            path.line_to({1, dot + 1});
            path.line_to({2, dot + 1});
            path.line_to({2, dot});
        }
        Canvas canvas(200, 400, ImageColorSpace::linear);
        canvas.fill(path, white);
        return canvas.take();
    };
    const auto alone = fill(0);
    for (const double dot : {1.0, 4.0}) {
        auto dotted = Image(*fill(dot));
        EXPECT_EQ(dotted.pixel(1, int(dot))[3], 1);
        for (int c = 0; c < 4; ++c) dotted.pixel(1, int(dot))[c] = 0;
        EXPECT_EQ(dotted.rgba, alone->rgba);
    }
    // Rows in the middle are full from the left edge on, as far as the picture reaches.
    EXPECT_EQ(alone->pixel(100, 130)[3], 1);
    EXPECT_EQ(alone->pixel(199, 130)[3], 1);
    EXPECT_EQ(alone->pixel(199, 391)[3], 0);
}

TEST(Canvas, FillsAShapeAlikeAfterOthers) {
    const Outline shape = line_outline({3.1, 140.7}, {96.2, 2.9}, 1.7);
    Canvas used(100, 150, ImageColorSpace::linear), fresh(100, 150, ImageColorSpace::linear);
    const Paint unseen{glm::dvec3(1), 0};
    used.fill(line_outline({-10, -10}, {120, 160}, 3), unseen);
    used.fill(disk_outline({80, 70}, 60.3), unseen);
    used.fill(outline_of({20.5, 3.25, 300, 140}), unseen);
    used.fill(shape, white);
    fresh.fill(shape, white);
    EXPECT_EQ(used.take()->rgba, fresh.take()->rgba);
}

TEST(Canvas, LaysShapesOverOneAnother) {
    Canvas canvas(2, 1, ImageColorSpace::linear);
    canvas.fill(Rectangle{0, 0, 1, 1}, {{1, 0, 0}, 0.5});
    canvas.fill(Rectangle{0, 0, 2, 1}, {{0, 0.5, 0}, 0.5});
    const auto layer = canvas.take();
    EXPECT_FLOAT_EQ(layer->pixel(0, 0)[0], 0.25f);
    EXPECT_FLOAT_EQ(layer->pixel(0, 0)[1], 0.25f);
    EXPECT_FLOAT_EQ(layer->pixel(0, 0)[3], 0.75f);
    EXPECT_FLOAT_EQ(layer->pixel(1, 0)[3], 0.5f);
}

// Half covered pixels of black text on white, and white on black, show code 128 of 255, as where
// display values are blended.
TEST(Canvas, EdgesOfTextLookAsInDisplayValues) {
    for (const bool dark : {false, true}) {
        Canvas canvas(1, 1, ImageColorSpace::linear);
        canvas.fill(Rectangle{0, 0, 0.5, 1},
                    {glm::dvec3(dark ? 0 : 1), 1,
                     dark ? Paint::Edges::of_dark_text : Paint::Edges::of_light_text});
        const float opacity = canvas.take()->pixel(0, 0)[3];
        const double stored = dark ? 1 - opacity : opacity;
        // light_of() is within .002 of the curve, whose slope there is .9: .56 codes.
        EXPECT_NEAR(stored, std::pow((0.5 + 0.055) / 1.055, 2.4), 0.002);
    }
}

}  // namespace
}  // namespace lamina
