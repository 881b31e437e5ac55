// SPDX-License-Identifier: Apache-2.0
#include "optics/colormap.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "base/error.h"
#include "optics/opacity.h"

namespace lamina {
namespace {

class ColormapTest : public testing::Test {
  protected:
    ~ColormapTest() override { std::filesystem::remove(file_); }

    Colormap read(const std::string& text) {
        std::ofstream(file_) << text;
        return read_paraview_colormap(file_);
    }

    std::string message_of(const std::string& text) {
        try {
            read(text);
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    }

    std::filesystem::path file_ = std::filesystem::temp_directory_path() /
                                  ("lamina_colormap_" + std::to_string(getpid()) + ".json");
};

glm::dvec3 color_at(const Colormap& colormap, double value) {
    return TransferFunction::linear(combine(colormap, {{0, 1}})).at(value).color;
}

void expect_near(const glm::dvec3& found, const glm::dvec3& expected, double tolerance) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], tolerance) << c;
}

TEST_F(ColormapTest, RgbIsStraightInSrgbNotInLinearLight) {
    const auto map = read(
        R"([{"Name": "ramp", "ColorSpace": "RGB", "RGBPoints": [0, 0, 0, 0, 10, 1, 0.5, 0]}])");
    for (double x = 0; x <= 1; x += 1 / 64.0) {
        // 5e-4 is twice the tolerance of SegmentSampler, which tests only three places of each
        // segment.
        expect_near(color_at(map, 10 * x), linear_from_srgb(glm::dvec3(x, x / 2, 0)), 5e-4);
    }
    EXPECT_EQ(color_at(map, 20), linear_from_srgb(glm::dvec3(1, 0.5, 0)));
    EXPECT_LT(map.colors.size(), 130u);
    EXPECT_TRUE(map.opacities.empty());
}

TEST_F(ColormapTest, StepTakesTheUpperColor) {
    const auto map = read(R"({"ColorSpace": "Step", "RGBPoints": [0, 1,0,0, 1, 0,1,0, 2, 0,0,1]})");
    EXPECT_EQ(color_at(map, -1), glm::dvec3(1, 0, 0));
    EXPECT_EQ(color_at(map, 0.01), glm::dvec3(0, 1, 0));
    EXPECT_EQ(color_at(map, 0.99), glm::dvec3(0, 1, 0));
    EXPECT_EQ(color_at(map, 1.01), glm::dvec3(0, 0, 1));
    EXPECT_EQ(color_at(map, 5), glm::dvec3(0, 0, 1));
}

TEST(ColorSpaceTest, HsvGoesThroughTheHues) {
    const glm::dvec3 red(1, 0, 0), blue(0, 0, 1), violet(1, 0, 0.5);
    expect_near(interpolate_srgb(ColorSpace::hsv, red, blue, 0.25), glm::dvec3(1, 1, 0), 1e-12);
    expect_near(interpolate_srgb(ColorSpace::hsv, red, blue, 0.5), glm::dvec3(0, 1, 0), 1e-12);
    // From hue 11/12 to hue 0: the long way round through cyan, or wrapped to 23/24.
    expect_near(interpolate_srgb(ColorSpace::hsv, violet, red, 0.5), glm::dvec3(0, 1, 0.75), 1e-12);
    expect_near(interpolate_srgb(ColorSpace::hsv_wrapped, violet, red, 0.5), glm::dvec3(1, 0, 0.25),
                1e-12);
    for (const double share : {0., 1.}) {
        expect_near(interpolate_srgb(ColorSpace::hsv, glm::dvec3(0.3, 0.5, 0.4),
                                     glm::dvec3(0.7, 0.1, 0.2), share),
                    share == 0 ? glm::dvec3(0.3, 0.5, 0.4) : glm::dvec3(0.7, 0.1, 0.2), 1e-12);
    }
}

TEST(ColorSpaceTest, LabAndDivergingKeepTheEndsAndGraysGray) {
    const glm::dvec3 a(0.23, 0.3, 0.75), b(0.7, 0.02, 0.15);
    for (const auto space : {ColorSpace::lab, ColorSpace::diverging}) {
        expect_near(interpolate_srgb(space, a, b, 0), a, 1e-9);
        expect_near(interpolate_srgb(space, a, b, 1), b, 1e-9);
        const glm::dvec3 gray = interpolate_srgb(space, glm::dvec3(0), glm::dvec3(1), 0.5);
        // L* = 50 is Y = ((50 + 16) / 116)^3.
        const double y = std::pow(66.0 / 116.0, 3);
        expect_near(linear_from_srgb(gray), glm::dvec3(y), 1e-9);
    }
}

TEST(ColorSpaceTest, LabOfRedIsThePublishedOne) {
    // Red is L* 53.24, a* 80.09, b* 67.20, and black is 0, 0, 0: in the middle L* is 26.62, Y =
    // ((26.62 + 16) / 116)^3.
    const glm::dvec3 half = linear_from_srgb(
        interpolate_srgb(ColorSpace::lab, glm::dvec3(0), glm::dvec3(1, 0, 0), 0.5));
    // Tolerance: published values have four digits, and a little blue below 0 is clipped.
    EXPECT_NEAR(0.2126 * half.r + 0.7152 * half.g + 0.0722 * half.b, std::pow(42.62 / 116.0, 3),
                2e-3);
    EXPECT_GT(half.r, 5 * half.g);
}

TEST(ColorSpaceTest, CoolToWarmHasMorelandsWhite) {
    // Moreland 2009, table: the middle of the cool-warm map from (59, 76, 192) to (180, 4, 38) is
    // (221, 221, 221).
    const glm::dvec3 middle =
        255.0 * interpolate_srgb(ColorSpace::diverging, glm::dvec3(59, 76, 192) / 255.0,
                                 glm::dvec3(180, 4, 38) / 255.0, 0.5);
    expect_near(middle, glm::dvec3(221), 1);
    // In this table, the colour at 1/4 is (141, 176, 254).
    const glm::dvec3 quarter =
        255.0 * interpolate_srgb(ColorSpace::diverging, glm::dvec3(59, 76, 192) / 255.0,
                                 glm::dvec3(180, 4, 38) / 255.0, 0.25);
    expect_near(quarter, glm::dvec3(141, 176, 254), 1.5);
}

TEST_F(ColormapTest, OpacitiesBecomeExtinctionsOverTheUnion) {
    const auto map =
        read(R"({"RGBPoints": [0, 1,1,1, 4, 1,1,1], "Points": [1, 0, 0.5, 0, 3, 0.5, 0.5, 0]})");
    const auto f = TransferFunction::linear(combine(map, 2.0));
    EXPECT_EQ(f.at(0).extinction, 0);
    const double between = extinction_from_opacity(0.25, 2);
    EXPECT_NEAR(f.at(2).extinction, between, between * opacity_slope_tolerance);
    EXPECT_DOUBLE_EQ(f.at(5).extinction, std::log(2) / 2);
    EXPECT_THROW(combine(read(R"({"RGBPoints": [0, 1,1,1]})"), 1.0), Error);
}

TEST_F(ColormapTest, CombineKeepsStepsOfBoth) {
    const Colormap map{
        {{0, glm::dvec3(0)}, {2, glm::dvec3(0)}, {2, glm::dvec3(1)}, {4, glm::dvec3(0)}}, {}};
    const auto f = TransferFunction::linear(combine(map, {{1, 0}, {3, 2}, {3, 8}}));
    EXPECT_EQ(f.knots().size(), 7u);
    EXPECT_EQ(f.at(2).extinction, 1);
    EXPECT_EQ(f.at(2).color.r, 1);
    EXPECT_EQ(f.at(3).extinction, 8);
    EXPECT_EQ(f.at(3).color.r, 0.5);
    EXPECT_EQ(f.max_extinction(2.5, 2.9), 1.9);
}

TEST_F(ColormapTest, ErrorsNameFileAndKey) {
    const std::string name = file_.string() + ": ";
    EXPECT_EQ(
        message_of(R"({"ColorSpace": "CMYK", "RGBPoints": [0,0,0,0]})"),
        name + R"(ColorSpace is "CMYK", expected "RGB", "HSV", "Lab", "Diverging" or "Step")");
    EXPECT_EQ(message_of("{}"), name + "RGBPoints is missing, expected [x, red, green, blue, ...]");
    EXPECT_EQ(message_of(R"({"RGBPoints": [0,0,0]})"),
              name + "RGBPoints has 3 numbers, expected four for every point");
    EXPECT_EQ(message_of(R"({"RGBPoints": [0,0,0,2]})"),
              name + "RGBPoints[3] is 2, expected a number from 0 to 1");
    EXPECT_EQ(message_of(R"({"RGBPoints": [0,0,0,"a"]})"),
              name + "RGBPoints[3] is \"a\", expected a number");
    EXPECT_EQ(message_of(R"({"RGBPoints": [1,0,0,0, 0,0,0,0]})"),
              name + "RGBPoints[4] is 0, expected at least 1, the scalar before it");
    EXPECT_EQ(
        message_of(R"({"RGBPoints": [1,0,0,0], "Points": [0, 1, 0.3, 0]})"),
        name + "point 0 of Points has midpoint 0.3 and sharpness 0, only 0.5 and 0 are supported");
    EXPECT_EQ(message_of("[]"),
              name + "found array, expected a ParaView preset: an object or an array with one");
    EXPECT_NE(message_of("{").find("parse error at line 1"), std::string::npos);
    EXPECT_THROW(read_paraview_colormap("no_such_file.json"), Error);
}

// A preset nested so deeply that a recursive reader, or a message that shows it, would overflow the
// stack.
TEST_F(ColormapTest, DeepNestingIsAnError) {
    const std::string lists = std::string(100000, '[') + std::string(100000, ']');
    for (const std::string& preset : {"{\"ColorSpace\": " + lists + ", \"RGBPoints\": [0,0,0,0]}",
                                      "{\"RGBPoints\": [" + lists + ",0,0,0]}", lists}) {
        const std::string message = message_of(preset);
        EXPECT_TRUE(message.starts_with(file_.string() + ": line 1, column ")) << message;
        EXPECT_TRUE(message.ends_with(": nested more than 64 deep")) << message;
    }
}

TEST_F(ColormapTest, TooManyPointsAreAnError) {
    const auto preset = [](int points) {
        std::string numbers;
        for (int i = 0; i < points; ++i) numbers += fmt::format("{}{},0,0,0", i > 0 ? "," : "", i);
        return "{\"RGBPoints\": [" + numbers + "]}";
    };
    EXPECT_EQ(read(preset(4096)).colors.size(), 4096u);
    EXPECT_EQ(message_of(preset(4097)),
              file_.string() + ": RGBPoints has 4097 points, expected at most 4096");
}

}  // namespace
}  // namespace lamina
