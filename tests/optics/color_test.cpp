// SPDX-License-Identifier: Apache-2.0
#include "lamina/color.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "optics/colormap.h"
#include "support/expect_error.h"

namespace lamina {
namespace {

TEST(Color, HexAndNamesAreDisplayValues) {
    const glm::dvec3 orange = color_of("#ff8019", ImageColorSpace::display);
    EXPECT_EQ(orange, glm::dvec3(255, 128, 25) / 255.0);
    EXPECT_EQ(color_of("#FF8019", ImageColorSpace::display), orange);
    EXPECT_EQ(color_of("tomato", ImageColorSpace::display), glm::dvec3(255, 99, 71) / 255.0);
    EXPECT_EQ(color_of("Tomato", ImageColorSpace::display),
              color_of("#ff6347", ImageColorSpace::display));
}

TEST(Color, IsDecodedForLinearLight) {
    // Expected (IEC 61966-2-1): ((v + .055) / 1.055)^2.4 above .04045, v / 12.92 below; up to
    // rounding.
    const glm::dvec3 orange = color_of("#ff8005");
    EXPECT_EQ(orange.r, 1);
    EXPECT_NEAR(orange.g, std::pow((128 / 255.0 + .055) / 1.055, 2.4), 1e-15);
    EXPECT_NEAR(orange.b, 5 / 255.0 / 12.92, 1e-15);
    EXPECT_EQ(color_of_display({1, 0, 5 / 255.0}).b, orange.b);
}

// Colours of up to 1 come back up to rounding: pow() with 2.4 multiplies by 2.4 the rounding of
// pow() with 1 / 2.4.
TEST(Color, DisplayValuesComeBack) {
    for (int code = 0; code <= 255; ++code) {
        const glm::dvec3 display(code / 255.0, 1 - code / 255.0, .5);
        for (const ImageColorSpace space : {ImageColorSpace::linear, ImageColorSpace::display}) {
            const glm::dvec3 back = display_of_color(color_of_display(display, space), space);
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(back[c], display[c], 2e-15) << code;
        }
    }
    const glm::dvec3 bright = display_of_color({0, 1, 7});
    EXPECT_EQ(bright.r, 0);
    EXPECT_NEAR(bright.g, 1, 2.3e-16);  // 1.055 - .055
    EXPECT_EQ(bright.b, bright.g);
    EXPECT_EQ(display_of_color({.25, 2, 0}, ImageColorSpace::display), glm::dvec3(.25, 1, 0));
}

TEST(Color, NamesAreThoseOfCss) {
    const auto colors = css_colors();
    EXPECT_EQ(colors.size(), 148u);
    for (std::size_t i = 1; i < colors.size(); ++i) EXPECT_LT(colors[i - 1].name, colors[i].name);
    EXPECT_EQ(css_color("rebeccapurple"), 0x663399u);
    EXPECT_EQ(css_color("aliceblue"), 0xf0f8ffu);
    EXPECT_EQ(css_color("yellowgreen"), 0x9acd32u);
    EXPECT_FALSE(css_color("zebra"));
}

TEST(Color, MistakesAreNamedWithASuggestion) {
    expect_error([] { color_of("#ff80"); }, {"#ff80", "six hexadecimal digits"});
    expect_error([] { color_of("#ff80g0"); }, {"six hexadecimal digits"});
    expect_error([] { color_of("tomatoe"); }, {"tomatoe", "did you mean \"tomato\"?"});
    expect_error([] { color_of("of a ripe plum"); }, {"\"#rrggbb\" or the name of a CSS colour"});
    expect_error([] { color_of(""); }, {"CSS colour"});
}

}  // namespace
}  // namespace lamina
