// SPDX-License-Identifier: Apache-2.0
#include "annotation/color_bar.h"

#include <gtest/gtest.h>

#include <cmath>

#include "image/coded_image.h"
#include "image/png.h"

namespace lamina {
namespace {

TransferKnot knot(double value, const glm::dvec3& color, double extinction) {
    return {value, {color, extinction}};
}

Scene scene_with(const TransferFunction& function, int width = 400, int height = 300) {
    Scene scene;
    scene.transfer_function = function;
    scene.width = width;
    scene.height = height;
    scene.annotations.colorbar = Annotation{};
    return scene;
}

AnnotatedData measured(double lo, double hi) {
    AnnotatedData data;
    data.range = {lo, hi};
    return data;
}

// A colour bar in the upper left corner of a picture.
struct DrawnBar {
    DrawnBar(const Scene& scene, const AnnotatedData& data, double height = 1e9) : style(scene) {
        Canvas canvas(scene.width, scene.height, scene.color_space);
        Pen pen(style, font, &canvas);
        bar =
            color_bar(pen, scene.annotations.colorbar.value_or(Annotation{}), scene, data, height);
        bar.block.draw(pen, {0, 0});
        picture = Image(scene.width, scene.height);
        picture.space = scene.color_space;
        picture.annotations = canvas.take();
        codes = coded_picture("bar", picture, scene.background, scene.color_space).codes.codes;
    }

    std::uint16_t code(double column, double row, int channel) const {
        const auto pixel = static_cast<std::size_t>(row) * std::size_t(picture.width) +
                           static_cast<std::size_t>(column);
        return codes[3 * pixel + std::size_t(channel)];
    }
    double opacity(double column, double row) const {
        return picture.annotations->pixel(int(column), int(row))[3];
    }

    AnnotationStyle style;
    Font font;
    ColorBar bar;
    Image picture;
    std::vector<std::uint16_t> codes;
};

TransferFunction colorful() {
    return TransferFunction::linear({knot(0, {0.1, 0.2, 0.9}, 0), knot(60, {0.1, 0.9, 0.3}, 1),
                                     knot(60, {0.9, 0.2, 0.1}, 3),
                                     knot(200, {0.7, 0.6, 0.05}, 0.5)});
}

TEST(ColorBar, HasTheColorsOfTheFunctionToTheCode) {
    for (const ImageColorSpace space : {ImageColorSpace::linear, ImageColorSpace::display}) {
        Scene scene = scene_with(colorful());
        scene.color_space = space;
        const DrawnBar drawn(scene, measured(0, 255));
        const Rectangle& bar = drawn.bar.colors;
        ASSERT_GT(bar.height, 100);
        for (int row = 0; row < bar.height; ++row) {
            const double value = value_at(drawn.bar.range, row, int(bar.height));
            const glm::dvec3 color = colorful().at(value).color;
            for (const double column : {bar.left, bar.right() - 1}) {
                for (int c = 0; c < 3; ++c) {
                    // Pictures are float32 until they are coded.
                    ASSERT_EQ(drawn.code(column, bar.top + row, c),
                              display_code(float(color[c]), space))
                        << value << ", channel " << c;
                }
            }
        }
    }
}

TEST(ColorBar, ShowsAStepBetweenTwoRows) {
    const TransferFunction step = TransferFunction::linear(
        {knot(0, {1, 0, 0}, 1), knot(100, {1, 0, 0}, 1), knot(100, {0, 0, 1}, 1)});
    const DrawnBar drawn(scene_with(step), measured(0, 300));
    const Rectangle& bar = drawn.bar.colors;
    for (int row = 0; row < bar.height; ++row) {
        const bool above = value_at(drawn.bar.range, row, int(bar.height)) >= 100;
        EXPECT_EQ(drawn.code(bar.left, bar.top + row, 0), above ? 0 : 255);
        EXPECT_EQ(drawn.code(bar.left, bar.top + row, 2), above ? 255 : 0);
    }
}

TEST(ColorBar, ReachesOverTheValuesThatShow) {
    const auto range = [](const TransferFunction& function, double lo, double hi) {
        const BarRange found = bar_range(function, {lo, hi});
        return std::pair(found.lo, found.hi);
    };
    const glm::dvec3 white(1);
    const TransferFunction hill = TransferFunction::linear(
        {knot(10, white, 0), knot(20, white, 0), knot(40, white, 2), knot(50, white, 0)});
    EXPECT_EQ(range(hill, 0, 255), std::pair(20.0, 50.0));
    EXPECT_EQ(range(hill, 30, 45), std::pair(30.0, 45.0));
    EXPECT_EQ(range(hill, 60, 90), std::pair(60.0, 90.0));  // nothing shows: all of the data
    const TransferFunction two = TransferFunction::linear(
        {knot(0, white, 1), knot(1, white, 0), knot(5, white, 0), knot(6, white, 1)});
    EXPECT_EQ(range(two, -2, 9), std::pair(0.0, 6.0));  // beyond there is one colour
    EXPECT_EQ(range(two, 7, 9), std::pair(7.0, 9.0));
    EXPECT_EQ(range(two, 0.5, 5.5), std::pair(0.5, 5.5));
    const TransferFunction step = TransferFunction::linear({knot(3, white, 0), knot(3, white, 7)});
    EXPECT_EQ(range(step, 0, 8), std::pair(3.0, 8.0));
}

// The curve's distance from the bar is the opacity that the scene's extinction has over the length
// that the bar names: with .9 at the largest extinction's end, half that extinction has 1 -
// sqrt(.1).
TEST(ColorBar, HasTheOpacitiesBesideTheColors) {
    // -log(1 - .9) / extinction is 2, a round number, so the length is 2.
    const double largest = -std::log(0.1) / 2 / (1 + 1e-9) * (1 - 1e-12);
    const TransferFunction ramp =
        TransferFunction::linear({knot(0, glm::dvec3(1), 0), knot(1, glm::dvec3(1), largest)});
    const DrawnBar drawn(scene_with(ramp, 1600, 1200), measured(0, 1));
    const Rectangle& bar = drawn.bar.colors;
    const double t = drawn.style.thickness(drawn.style.em);
    const double base = bar.left - 2 * t, whole = base - t;
    for (const double share : {0.25, 0.5, 0.75}) {
        const double row = bar.top + std::round((1 - share) * bar.height);
        // From the frame's left side on nothing is covered before the curve.
        double begin = std::ceil(t);
        while (drawn.opacity(begin, row) == 0) ++begin;
        const double expected = base - whole * (1 - std::pow(0.1, share));
        EXPECT_NEAR(begin, expected, t + 1.5) << share;
    }
}

TEST(ColorBar, NamesTheQuantityAndItsUnit) {
    const auto width = [](const std::string& name, const std::string& unit) {
        AnnotatedData data = measured(0, 1);
        data.quantity = {name, unit};
        return DrawnBar(scene_with(colorful()), data).bar.colors.top;
    };
    EXPECT_LT(width("", ""), width("T", "K"));
    // A long name leaves the unit to a line of its own.
    EXPECT_GT(width("turbulent kinetic energy", "m2/s2"), width("T", "K"));
}

TEST(ColorBar, FitsIntoSmallPictures) {
    for (const auto& [width, height] : {std::pair(300, 200), {120, 60}, {1920, 1080}}) {
        const Scene scene = scene_with(colorful(), width, height);
        const DrawnBar drawn(scene, measured(0, 255));
        EXPECT_LE(drawn.bar.block.size.y, height);
        EXPECT_GT(drawn.bar.colors.height, 0);
    }
}

// A bar shrinks to half for others, never below.
TEST(ColorBar, LeavesRoomToOthers) {
    const Scene scene = scene_with(colorful());
    const DrawnBar whole(scene, measured(0, 255));
    const double height = whole.bar.block.size.y;
    const DrawnBar lower(scene, measured(0, 255), height - 40);
    EXPECT_LE(lower.bar.block.size.y, height - 40);
    EXPECT_GT(lower.bar.block.size.y, height - 60);
    const DrawnBar least(scene, measured(0, 255), 10);
    EXPECT_EQ(least.bar.colors.height, whole.bar.colors.height / 2);
}

// One number says nothing about a range. Whatever the range, numbers are at least a line apart.
TEST(ColorBar, HasTwoNumbersOrNone) {
    const TransferFunction ramp =
        TransferFunction::linear({knot(0, {0.1, 0.2, 0.9}, 1), knot(1, {0.9, 0.2, 0.1}, 1)});
    for (const int height : {40, 60, 80, 100, 150, 300}) {
        for (const auto& [lo, hi] : {std::pair(0.6, 1.4),
                                     {0.0, 1.9},
                                     {-3.0, 3.0},
                                     {0.99, 1.01},
                                     {0.1, 0.2},
                                     {5.0, 105.0}}) {
            const DrawnBar drawn(scene_with(ramp, 200, height), measured(lo, hi));
            const std::vector<double>& rows = drawn.bar.ticks;
            EXPECT_NE(rows.size(), 1u) << height << " " << lo;
            EXPECT_EQ(rows.empty(), drawn.bar.colors.height < 1.35 * drawn.style.em)
                << height << " " << lo;
            for (std::size_t i = 1; i < rows.size(); ++i)
                EXPECT_GE(rows[i - 1] - rows[i], 1.35 * drawn.style.em - 1e-9) << height << lo;
        }
    }
}

TEST(ColorBar, ShowsASingleValue) {
    const DrawnBar drawn(scene_with(colorful()), measured(70, 70));
    const glm::dvec3 color = colorful().at(70).color;
    EXPECT_EQ(drawn.code(drawn.bar.colors.left, drawn.bar.colors.top, 0),
              display_code(float(color.r), ImageColorSpace::linear));
}

TEST(ColorBar, NamesAndUnitsOfAnyLengthTakeLittleRoom) {
    AnnotatedData data = measured(0, 1);
    data.quantity = {std::string(1'000'000, 'n'), std::string(1'000'000, 'u')};
    data.length_unit = std::string(1'000'000, 'm');
    const DrawnBar drawn(scene_with(colorful()), data);
    EXPECT_LT(drawn.bar.block.size.x, 2 * widest_name * drawn.style.em);
}

}  // namespace
}  // namespace lamina
