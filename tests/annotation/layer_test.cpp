// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>

#include "annotation/annotation_layer.h"
#include "annotation/layout.h"
#include "image/coded_image.h"
#include "mesh/predicates.h"
#include "support/expect_error.h"
#include "support/heard_warnings.h"

namespace lamina {
namespace {

Scene plain_scene() {
    Scene scene;
    scene.transfer_function =
        TransferFunction::linear({{0, {glm::dvec3(0.2), 0}}, {1, {glm::dvec3(0.9, 0.5, 0.1), 2}}});
    scene.width = 300;
    scene.height = 200;
    return scene;
}

AnnotatedData plain_data() {
    AnnotatedData data;
    data.corners = box_corners(glm::dvec3(-0.2), glm::dvec3(0.2));
    data.range = {0, 1};
    return data;
}

Annotation titled(const std::string& text) {
    Annotation title;
    title.text = text;
    return title;
}

TEST(AnnotationLayer, IsThereOnlyIfSomethingIsWanted) {
    const Image picture(300, 200);
    EXPECT_EQ(annotation_layer(plain_scene(), plain_data(), picture), nullptr);
    Scene scene = plain_scene();
    scene.annotations.title = titled("A title");
    const auto layer = annotation_layer(scene, plain_data(), picture);
    ASSERT_NE(layer, nullptr);
    EXPECT_EQ(layer->width, 300);
    EXPECT_EQ(layer->height, 200);
}

TEST(AnnotationLayer, HasNoColorBarIfNothingShows) {
    Scene scene = plain_scene();
    scene.annotations.colorbar = Annotation{};
    AnnotatedData data = plain_data();
    data.range = {-3, -1};
    const test::HeardWarnings heard;
    const auto layer = annotation_layer(scene, data, Image(300, 200));
    EXPECT_TRUE(std::ranges::all_of(layer->rgba, [](float number) { return number == 0; }));
    EXPECT_NE(heard.all().find("shows none of the data's values"), std::string::npos);
}

// The contrast ratio of WCAG 2 between ink and background; it asks for 3 of large text.
TEST(AnnotationLayer, InkIsReadableOnEveryBackground) {
    for (int red = 0; red <= 255; red += 51) {
        for (int green = 0; green <= 255; green += 51) {
            for (int blue = 0; blue <= 255; blue += 51) {
                Scene scene = plain_scene();
                scene.background = {linear_from_srgb(red / 255.0), linear_from_srgb(green / 255.0),
                                    linear_from_srgb(blue / 255.0)};
                const AnnotationStyle style(scene);
                const auto luminance = [](const glm::dvec3& c) {
                    return 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b + 0.05;
                };
                const double a = luminance(style.ink), b = luminance(scene.background);
                EXPECT_GE(std::max(a, b) / std::min(a, b), 3.7) << red << green << blue;
                scene.color_space = ImageColorSpace::display;
                scene.background = glm::dvec3(red, green, blue) / 255.0;
                EXPECT_EQ(AnnotationStyle(scene).dark_ink, style.dark_ink);
            }
        }
    }
}

TEST(AnnotationLayer, APlateLiesUnderTextOnlyOverWhatThePictureShows) {
    Scene scene = plain_scene();
    scene.annotations.title = titled(".");
    const auto plated = [&](const Image& picture) {
        const auto layer = annotation_layer(scene, plain_data(), picture);
        int covered = 0;
        for (std::size_t i = 3; i < layer->rgba.size(); i += 4) covered += layer->rgba[i] > 0;
        return covered;
    };
    Image picture(300, 200);
    const int text_alone = plated(picture);
    EXPECT_LT(text_alone, 30);
    picture.pixel(150, 190)[3] = 1;  // far from the title
    EXPECT_EQ(plated(picture), text_alone);
    picture.pixel(150, 10)[3] = 0.5;
    EXPECT_GT(plated(picture), 60);
}

TEST(AnnotationLayer, ColorBarOrLegendIsWhatFitsTheData) {
    Scene scene = plain_scene();
    scene.annotations.colorbar = scene.annotations.labels = Annotation{};
    AnnotatedData data = plain_data();
    const Image picture(300, 200);
    const auto bar = annotation_layer(scene, data, picture);
    data.are_labels = true;
    data.labels = {{0, "0"}, {1, "1", "Femur"}};
    const auto legend = annotation_layer(scene, data, picture);
    EXPECT_NE(bar->rgba, legend->rgba);
    scene.annotations.labels.reset();
    EXPECT_EQ(annotation_layer(scene, data, picture)->rgba, bar->rgba);
    scene.annotations.labels = Annotation{};
    scene.annotations.colorbar.reset();
    EXPECT_EQ(annotation_layer(scene, data, picture)->rgba, legend->rgba);
}

TEST(AnnotationLayer, LegendHasTheColorsOfTheLabelsThatShow) {
    Scene scene = plain_scene();
    scene.transfer_function = TransferFunction::nearest(
        {{0, {{0, 0, 0}, 0}}, {1, {{1, 0, 0}, 1}}, {2, {{0, 0.5, 0}, 1}}, {3, {{0, 0, 1}, 0}}});
    scene.annotations.labels = Annotation{};
    AnnotatedData data = plain_data();
    data.are_labels = true;
    for (const int code : {0, 1, 2, 3}) data.labels.push_back({double(code), "1"});
    const auto layer = annotation_layer(scene, data, Image(300, 200));
    const auto count = [&](const glm::vec3& color) {
        int pixels = 0;
        for (std::size_t i = 0; i < layer->rgba.size(); i += 4) {
            pixels += layer->rgba[i] == color.r && layer->rgba[i + 1] == color.g &&
                      layer->rgba[i + 2] == color.b && layer->rgba[i + 3] == 1;
        }
        return pixels;
    };
    EXPECT_GT(count({1, 0, 0}), 40);
    EXPECT_EQ(count({1, 0, 0}), count({0, 0.5, 0}));
    EXPECT_EQ(count({0, 0, 1}), 0);
}

TEST(AnnotationLayer, SaysWhatItCannotShow) {
    const auto said = [](const Scene& scene, const AnnotatedData& data) {
        const test::HeardWarnings heard;
        annotation_layer(scene, data, Image(300, 200));
        return heard.all();
    };
    Scene scene = plain_scene();
    scene.annotations.title = titled("Schädel \u6f22");
    EXPECT_NE(said(scene, plain_data()).find("U+6F22"), std::string::npos);
    scene.annotations.title = titled("Schädel");
    EXPECT_EQ(said(scene, plain_data()), "");
    scene.annotations.title = titled("Schädel, von vorn und von oben");
    scene.annotations.title->size = 4;
    EXPECT_NE(said(scene, plain_data())
                  .find("title: is too long for a picture 300 pixels wide, "
                        "and is written smaller"),
              std::string::npos);
    scene.annotations.title = titled(std::string(200, 'x') + "\nshort");
    EXPECT_NE(said(scene, plain_data()).find("pixels wide, and is cut"), std::string::npos);
    scene = plain_scene();
    scene.annotations.labels = Annotation{};
    EXPECT_NE(said(scene, plain_data()).find("no labels"), std::string::npos);
    AnnotatedData many = plain_data();
    many.are_labels = true;
    for (int i = 0; i < 100; ++i) many.labels.push_back({1, "1"});
    many.labels.back().name = "\u6f22";  // has no room, so it needs no glyph
    EXPECT_NE(said(scene, many).find("of 100 labels"), std::string::npos);
    EXPECT_EQ(said(scene, many).find("U+6F22"), std::string::npos);
}

Annotations everything() {
    Annotations all;
    all.colorbar = all.scale_bar = all.axes = Annotation{};
    all.title = titled("Temperature at the wall");
    all.texts = {titled("preliminary")};
    return all;
}

// Blocks that are drawn in the order of their ranks, by the keys that the warning does not name.
std::vector<std::string> left_out(int width, int height, const Annotations& wanted) {
    Scene scene = plain_scene();
    scene.width = width;
    scene.height = height;
    scene.annotations = wanted;
    scene.camera = Camera{};
    const test::HeardWarnings heard;
    annotation_layer(scene, plain_data(), Image(width, height));
    std::vector<std::string> keys;
    for (const char* const key : {"title", "colorbar", "scale_bar", "axes", "texts.0"})
        if (heard.all().find(key) != std::string::npos) keys.emplace_back(key);
    return keys;
}

// Blocks that are more important stay. A picture of 300 x 200 has room for all, as larger ones
// have.
TEST(AnnotationLayer, LeavesOutWhatDoesNotFitInTheOrderOfImportance) {
    using Keys = std::vector<std::string>;
    for (const auto& [width, height] : {std::pair(300, 200), {480, 360}, {800, 600}, {1920, 1080}})
        EXPECT_EQ(left_out(width, height, everything()), Keys{}) << width;
    std::size_t before = 0;
    for (const int width : {300, 200, 160, 120, 90, 60, 30, 10}) {
        const Keys keys = left_out(width, width * 2 / 3, everything());
        EXPECT_GE(keys.size(), before) << width;
        before = keys.size();
    }
    EXPECT_EQ(before, 5u);
    // Two titles' worth of texts in one corner: the second is as important as the first.
    Annotations texts;
    texts.texts = {titled("one"), titled(std::string(80, 'x'))};
    EXPECT_EQ(left_out(300, 200, texts), Keys{});
    texts.texts = {titled(std::string(80, 'x'))};
    EXPECT_EQ(left_out(300, 200, texts), Keys{"texts.0"});
}

// The axes may take 7.2 ems of 9 pixels, 65, beside a gap of 7.2: 144.4 pixels are twice as many.
TEST(AnnotationLayer, LeavesOutAxesThatWouldReachTheMiddle) {
    using Keys = std::vector<std::string>;
    Annotations axes;
    axes.axes = Annotation{};
    EXPECT_EQ(left_out(145, 145, axes), Keys{});
    EXPECT_EQ(left_out(144, 145, axes), Keys{"axes"});
    EXPECT_EQ(left_out(400, 144, axes), Keys{"axes"});
    axes.axes->size = .5;
    EXPECT_EQ(left_out(144, 144, axes), Keys{});
}

// Blocks that take_misfits() leaves lie in the picture, and no two of them overlap.
TEST(AnnotationLayer, WhatStaysDoesNotOverlap) {
    for (int width = 20; width <= 400; width += 20) {
        Scene scene = plain_scene();
        scene.width = width;
        scene.height = width * 3 / 4;
        const AnnotationStyle style(scene);
        std::vector<Block> blocks;
        int rank = 0;
        for (const AnnotationPosition position :
             {AnnotationPosition::right, AnnotationPosition::top, AnnotationPosition::bottom_right,
              AnnotationPosition::bottom_left, AnnotationPosition::bottom_left}) {
            Block block;
            block.key = std::to_string(rank);
            block.position = position;
            block.size = {80, 45};
            block.rank = rank++;
            blocks.push_back(block);
        }
        const std::vector<std::string> out = take_misfits(blocks, style);
        EXPECT_EQ(blocks.size() + out.size(), 5u);
        const std::vector<Rectangle> places = placed(blocks, style);
        for (std::size_t i = 0; i < places.size(); ++i) {
            EXPECT_TRUE(style.holds(places[i])) << width;
            for (std::size_t j = 0; j < i; ++j)
                EXPECT_FALSE(overlap(places[i], places[j])) << width;
        }
    }
}

// A title that is written smaller fits; its letters keep 9 pixels, and a longer one is cut.
TEST(AnnotationLayer, LongTitlesFit) {
    const Scene scene = plain_scene();
    const AnnotationStyle style(scene);
    Font font;
    Pen pen(style, font, nullptr);
    double before = 1e9;
    for (const std::size_t length : {10, 45, 60, 100, 1000}) {
        const Block block =
            text_block(pen, titled(std::string(length, 'x')), 12, "title", AnnotationPosition::top);
        EXPECT_LE(block.size.x, 300 - 2 * style.gap) << length;
        EXPECT_LE(block.size.y, before) << length;
        EXPECT_GE(block.size.y, 9) << length;
        EXPECT_EQ(block.note.empty(), length == 10) << block.note;
        before = block.size.y;
    }
}

TEST(AnnotationLayer, LinesEndWithOrWithoutACarriageReturn) {
    const auto drawn = [](const std::string& text) {
        Scene scene = plain_scene();
        scene.annotations.title = titled(text);
        const test::HeardWarnings heard;
        const auto layer = annotation_layer(scene, plain_data(), Image(300, 200));
        EXPECT_EQ(heard.all(), "");
        return layer->rgba;
    };
    EXPECT_EQ(drawn("one\r\ntwo\r\n"), drawn("one\ntwo\n"));
    EXPECT_EQ(lines_of("a\n\nb"), (std::vector<std::string_view>{"a", "", "b"}));
    EXPECT_EQ(lines_of(""), std::vector<std::string_view>{""});
}

TEST(AnnotationLayer, SmallestPicturesHoldNumbers) {
    const test::HeardWarnings heard;
    for (const auto& [width, height] : {std::pair(1, 1), {32, 32}, {1, 200}, {200, 1}}) {
        for (const double size : {Annotation::least_size, 1.0, Annotation::largest_size}) {
            for (const bool labels : {false, true}) {
                Scene scene = plain_scene();
                scene.width = width;
                scene.height = height;
                Annotation every;
                every.size = size;
                Annotations& wanted = scene.annotations;
                wanted.colorbar = wanted.labels = wanted.scale_bar = wanted.axes = wanted.box =
                    every;
                every.text = "Title\nof two lines";
                wanted.title = every;
                wanted.texts = {every, every};
                AnnotatedData data = plain_data();
                data.quantity = {"Temperature", "K"};
                data.length_unit = "mm";
                data.are_labels = labels;
                if (labels) data.labels = {{0, "0"}, {1, "1", "Femur"}, {0.5, "2", "Tibia"}};
                const PictureMargins margins = annotation_margins(scene, data);
                EXPECT_LE(margins.left + margins.right, 0.6 * width + 1e-12);
                EXPECT_LE(margins.top + margins.bottom, 0.6 * height + 1e-12);
                scene.camera = Camera{};
                Image picture(width, height);
                std::ranges::fill(picture.rgba, 0.5f);
                const auto layer = annotation_layer(scene, data, picture);
                ASSERT_EQ(layer->rgba.size(), picture.rgba.size());
                EXPECT_TRUE(std::ranges::all_of(
                    layer->rgba, [](float number) { return number >= 0 && number <= 1; }));
            }
        }
    }
}

TEST(AnnotationLayer, RefusesTextsAndFormatsThatAreNone) {
    Scene scene = plain_scene();
    scene.annotations.texts = {titled("good"), titled("b\xff")};
    const auto draw = [&] { annotation_layer(scene, plain_data(), Image(300, 200)); };
    expect_error(draw, {"image.annotations.texts.1.text", "UTF-8"});
    scene.annotations = {};
    scene.annotations.colorbar = Annotation{};
    scene.annotations.colorbar->format = "{:d}";
    expect_error(draw, {"image.annotations.colorbar.format", "{:d}"});
    scene.annotations.colorbar->format.clear();
    scene.annotations.colorbar->size = 9;
    expect_error(draw, {"image.annotations.colorbar.size", "9", "4"});
}

TEST(AnnotationMargins, AreOnTheSidesOfTheAnnotations) {
    Scene scene = plain_scene();
    EXPECT_EQ(annotation_margins(scene, plain_data()).right, 0);
    scene.annotations.colorbar = Annotation{};
    const PictureMargins margins = annotation_margins(scene, plain_data());
    EXPECT_GT(margins.right, 40);
    EXPECT_LT(margins.right, 130);
    EXPECT_EQ(margins.left, 0);
    EXPECT_EQ(margins.top, 0);
    scene.annotations.colorbar->position = AnnotationPosition::left;
    EXPECT_DOUBLE_EQ(annotation_margins(scene, plain_data()).left, margins.right);
    scene.annotations.colorbar.reset();
    scene.annotations.title = titled("x");
    EXPECT_GT(annotation_margins(scene, plain_data()).top, 10);
    // The data keep two fifths of a picture that is too small for what is wanted.
    scene.annotations.colorbar = scene.annotations.scale_bar = scene.annotations.box = Annotation{};
    scene.width = scene.height = 16;
    const PictureMargins small = annotation_margins(scene, plain_data());
    EXPECT_NEAR(small.left + small.right, 0.6 * 16, 1e-12);
    EXPECT_NEAR(small.top + small.bottom, 0.6 * 16, 1e-12);
}

}  // namespace
}  // namespace lamina
