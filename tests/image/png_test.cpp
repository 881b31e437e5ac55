// SPDX-License-Identifier: Apache-2.0
#include "image/png.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "base/output_file.h"
#include "image/coded_image.h"
#include "image/test_images.h"
#include "support/expect_error.h"
#include "support/file_size_limit.h"

namespace lamina {
namespace {

std::size_t save_png(const std::filesystem::path& path, const Image& image,
                     const glm::dvec3& background = glm::dvec3(0)) {
    AtomicFile file(path);
    const std::size_t clamped = write_png(file, image, background);
    file.commit();
    return clamped;
}

void save_png(const std::filesystem::path& path, const CodedImage& image) {
    AtomicFile file(path);
    write_png(file, image);
    file.commit();
}

Image row_of(const std::vector<std::vector<float>>& pixels) {
    Image image(static_cast<int>(pixels.size()), 1);
    for (int i = 0; i < image.width; ++i) {
        std::copy_n(pixels[static_cast<std::size_t>(i)].begin(), 4, image.pixel(i, 0));
    }
    return image;
}

std::string big_endian(std::uint32_t value) {
    std::string bytes;
    for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 255);
    return bytes;
}

std::string chunk(const std::string& type, const std::string& data) {
    const std::string body = type + data;
    const auto crc =
        crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size()));
    return big_endian(static_cast<std::uint32_t>(data.size())) + body +
           big_endian(static_cast<std::uint32_t>(crc));
}

// Makes a PNG from its parts, independently of libpng. `before_data`: chunks in front of the data.
// `rows`: the filter byte and packed codes of each row.
std::string png_bytes(std::uint32_t width, std::uint32_t height, char depth, char color_type,
                      char interlace, const std::string& before_data, const std::string& rows) {
    std::string packed(compressBound(rows.size()), ' ');
    uLongf length = packed.size();
    compress(reinterpret_cast<Bytef*>(packed.data()), &length,
             reinterpret_cast<const Bytef*>(rows.data()), rows.size());
    packed.resize(length);
    const std::string header = big_endian(width) + big_endian(height) + depth + color_type +
                               std::string(2, '\0') + interlace;
    return "\x89PNG\r\n\x1a\n" + chunk("IHDR", header) + before_data + chunk("IDAT", packed) +
           chunk("IEND", "");
}

using Codes = std::vector<std::uint16_t>;

TEST(Srgb, HasTheValuesOfTheStandard) {
    // Values of IEC 61966-2-1, as in many tables (6 digits). Near 0 the curve is 12.92 x.
    EXPECT_NEAR(srgb_from_linear(0.5), 0.735357, 5e-7);
    EXPECT_NEAR(srgb_from_linear(0.18), 0.461356, 5e-7);
    EXPECT_DOUBLE_EQ(srgb_from_linear(0.001), 0.01292);
    EXPECT_DOUBLE_EQ(srgb_from_linear(1), 1);
    // On both sides of each of the 255 borders between codes, the code is that of the formula.
    for (int code = 1; code < 256; ++code) {
        const double border = linear_from_srgb((code - .5) / 255);
        EXPECT_EQ(display_code(border * (1 + 1e-12), ImageColorSpace::linear), code);
        EXPECT_EQ(display_code(border * (1 - 1e-12), ImageColorSpace::linear), code - 1);
    }
    for (int i = 0; i <= 100000; ++i) {
        const double linear = i / 100000.;
        ASSERT_EQ(display_code(linear, ImageColorSpace::linear),
                  std::lround(255 * srgb_from_linear(linear)));
    }
    for (int code = 0; code <= 255; ++code) {
        EXPECT_NEAR(srgb_from_linear(linear_from_srgb(code / 255.0)), code / 255.0, 1e-15 * 20);
    }
}

TEST(Png, AppliesTheBackgroundThenTheCurveThenRounds) {
    const TemporaryFolder folder;
    const Image image = row_of({{0.5f, 0.18f, 0.001f, 1}, {0.25f, 0, 0, 0.5f}, {0, 0, 0, 0}});
    EXPECT_EQ(save_png(folder / "a.png", image, {0.5, 0.36, 1}), 0u);
    const CodedImage back = read_png(folder / "a.png");
    ASSERT_EQ(back.width, 3);
    ASSERT_EQ(back.height, 1);
    ASSERT_EQ(back.channels, 3);
    ASSERT_EQ(back.bit_depth, 8);
    // First pixel: 255 * .735357 = 187.516, 255 * .461356 = 117.6, 255 * .01292 = 3.3. Second
    // pixel: .25 + .5 * .5 = .5 (188), .5 * .36 = .18 (118) and .5 (188). Third pixel: the
    // background itself; .36 -> .634524 (161.8).
    EXPECT_EQ(back.codes, (Codes{188, 118, 3, 188, 118, 188, 188, 162, 255}));
}

// 255 (.25 + .5 * .5) = 127.5 rounds up, and so does 255 * .1 = 25.5, as .1f is a little more than
// .1. Values above 1 are clamped.
TEST(Png, DisplayValuesAreStoredAsTheyAre) {
    const TemporaryFolder folder;
    const Image image = row_of({{0.25f, 0, 0.1f, 0.5f}, {1, 0.2f, 1.5f, 1}});
    AtomicFile file(folder / "a.png");
    EXPECT_EQ(write_png(file, image, glm::dvec3(0.5, 1, 0), ImageColorSpace::display), 1u);
    file.commit();
    EXPECT_EQ(read_png(folder / "a.png").codes, (Codes{128, 128, 26, 255, 51, 255}));
}

// Half covered pixels show twice their associated colour: .25 / .5 = .5 -> 188, .18 -> 118; .001 ->
// 3; the opacity .5 -> 127.5, rounded up. The background does not matter.
TEST(Png, TransparentHasStraightAlphaAndNoBackground) {
    const TemporaryFolder folder;
    const Image image = row_of({{0.25f, 0.09f, 0.0005f, 0.5f},
                                {0, 0, 0, 0},
                                {0.5f, 0.18f, 0.001f, 1},
                                {0.6f, 0, 0, 0.5f}});
    AtomicFile file(folder / "a.png");
    // Only the last pixel is clamped: it shines more than it covers.
    EXPECT_EQ(write_png(file, image, {{0.5, 0.36, 1}, true}), 1u);
    file.commit();
    const CodedImage back = read_png(folder / "a.png");
    ASSERT_EQ(back.channels, 4);
    EXPECT_EQ(back.codes, (Codes{188, 118, 3, 128, 0, 0, 0, 0, 188, 118, 3, 255, 255, 0, 0, 128}));
    const Image display = row_of({{0.25f, 0.05f, 0, 0.5f}});
    EXPECT_EQ(coded_picture("a", display, {{}, true}, ImageColorSpace::display).codes.codes,
              (Codes{128, 26, 0, 128}));
}

// Composited over a background in linear light, a transparent PNG is the picture itself over it.
// Codes differ from their numbers by at most half a code: e. The opacity changes light by e times
// the difference of colour and background, at most 1; the colour by e times the curve's largest
// slope, 2.4 / 1.055.
TEST(Png, TransparentOverABackgroundIsThePictureOverIt) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> share(0, 1);
    Image image(40, 30);
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
        const float alpha = share(random);
        for (std::size_t c = 0; c < 3; ++c) image.rgba[i + c] = alpha * share(random);
        image.rgba[i + 3] = alpha;
    }
    for (const int bits : {8, 16}) {
        const double most = bits == 8 ? 255 : 65535, e = .5 / most;
        const CodedPicture coded = coded_picture("a", image, {{}, true, bits}, {});
        EXPECT_EQ(coded.clamped_pixels, 0u);
        EXPECT_EQ(coded.codes.bit_depth, bits);
        for (std::size_t i = 0; i < image.rgba.size(); ++i) {
            const double alpha = coded.codes.codes[i | 3] / most, behind = .3;
            if ((i & 3) == 3) continue;
            const double over =
                alpha * linear_from_srgb(coded.codes.codes[i] / most) + (1 - alpha) * behind;
            const double exact = image.rgba[i] + (1.0 - image.rgba[i | 3]) * behind;
            EXPECT_NEAR(over, exact, e * (1 + 2.4 / 1.055) + 1e-6) << i;
        }
    }
}

TEST(Png, SixteenBitsAreThoseOfTheCurve) {
    for (const double value : {0., 1e-5, .001, .0031308, .18, .5, .999, 1., 1.5, -1.}) {
        const double shown = std::clamp(value, 0., 1.);
        EXPECT_EQ(display_code(value, ImageColorSpace::linear, 16),
                  std::lround(65535 * srgb_from_linear(shown)));
        EXPECT_EQ(display_code(value, ImageColorSpace::display, 16), std::lround(65535 * shown));
    }
    const Image image = row_of({{0.5f, 0, 0, 0.5f}});
    EXPECT_EQ(coded_picture("a", image, {{0, 1, 0}, false, 16}, {}).codes.codes,
              (Codes{48192, 48192, 0}));  // 65535 * .735357 = 48191.6
}

TEST(Png, BytesInMemoryAreThoseOfTheFile) {
    const TemporaryFolder folder;
    const Image image = row_of({{0.5f, 0.18f, 0.001f, 1}, {0.25f, 0, 0, 0.5f}});
    for (const PngLook& look : {PngLook{}, PngLook{{}, true, 16}}) {
        AtomicFile file(folder / "a.png");
        write_png(file, image, look);
        file.commit();
        EXPECT_EQ(encode_png(image, look, {}), read_bytes_of(folder / "a.png"));
    }
}

TEST(Png, EveryCodeComesBack) {
    const TemporaryFolder folder;
    Image image(256, 1);
    for (int code = 0; code < 256; ++code) {
        const auto linear = static_cast<float>(linear_from_srgb(code / 255.0));
        for (int channel = 0; channel < 3; ++channel) image.pixel(code, 0)[channel] = linear;
        image.pixel(code, 0)[3] = 1;
    }
    EXPECT_EQ(save_png(folder / "a.png", image), 0u);
    const CodedImage back = read_png(folder / "a.png");
    for (std::size_t i = 0; i < back.codes.size(); ++i) EXPECT_EQ(back.codes[i], i / 3);
}

TEST(Png, CountsPixelsThatWereClamped) {
    const TemporaryFolder folder;
    // Two pixels count as clamped: that with 1.5 and -.5, which counts once, and that with 1.01.
    // Excesses below 1/510 = .00196 are not counted.
    const Image image = row_of({{1.5f, -0.5f, 0, 1}, {0, 0, 1.01f, 1}, {1.001f, -0.001f, 0, 1}});
    EXPECT_EQ(save_png(folder / "a.png", image), 2u);
    EXPECT_EQ(read_png(folder / "a.png").codes, (Codes{255, 0, 0, 0, 0, 255, 255, 0, 0}));
}

TEST(Png, SaysThatItIsSrgbAndHasNoTime) {
    const TemporaryFolder folder;
    const Image image = row_of({{0.1f, 0.2f, 0.3f, 1}});
    save_png(folder / "a.png", image);
    save_png(folder / "b.png", image);
    const std::string bytes = read_bytes_of(folder / "a.png");
    EXPECT_EQ(bytes, read_bytes_of(folder / "b.png"));
    EXPECT_NE(bytes.find("sRGB"), std::string::npos);
    EXPECT_EQ(bytes.find("tIME"), std::string::npos);
}

TEST(Png, CodesOfEveryKindComeBack) {
    const TemporaryFolder folder;
    for (const int channels : {1, 2, 3, 4}) {
        for (const int depth : {8, 16}) {
            CodedImage image(5, 3, channels, depth);
            for (std::size_t i = 0; i < image.codes.size(); ++i) {
                image.codes[i] =
                    static_cast<std::uint16_t>(i * 40503 % (depth == 16 ? 65536 : 256));
            }
            save_png(folder / "a.png", image);
            const CodedImage back = read_png(folder / "a.png");
            EXPECT_EQ(back.channels, channels);
            EXPECT_EQ(back.bit_depth, depth);
            EXPECT_EQ(back.codes, image.codes);
        }
    }
}

TEST(Png, ExpandsPalettesSmallDepthsAndTransparency) {
    const TemporaryFolder folder;
    using namespace std::string_literals;
    const auto read = [&](const std::string& bytes) {
        write_bytes_to(folder / "a.png", bytes);
        return read_png(folder / "a.png");
    };
    // A palette of 2 bits: the pixels 2, 1, 0 are the bits 10 01 00.
    const std::string palette = chunk("PLTE", "\x01\x02\x03\x04\x05\x06\x07\x08\x09"s);
    EXPECT_EQ(read(png_bytes(3, 1, 2, 3, 0, palette, "\0\x90"s)).codes,
              (Codes{7, 8, 9, 4, 5, 6, 1, 2, 3}));
    // Grey of 1 bit: the pixels 1, 0, 1.
    EXPECT_EQ(read(png_bytes(3, 1, 1, 0, 0, "", "\0\xA0"s)).codes, (Codes{255, 0, 255}));
    // RGB with the transparent colour (1, 2, 3).
    const std::string transparent = chunk("tRNS", "\0\x01\0\x02\0\x03"s);
    const CodedImage rgba =
        read(png_bytes(2, 1, 8, 2, 0, transparent, "\0\x01\x02\x03\x01\x02\x04"s));
    EXPECT_EQ(rgba.channels, 4);
    EXPECT_EQ(rgba.codes, (Codes{1, 2, 3, 0, 1, 2, 4, 255}));
    // Grey of 2 x 2 pixels, interlaced by Adam7: pass 1 has (0, 0), pass 6 has (1, 0), pass 7 the
    // row below.
    EXPECT_EQ(read(png_bytes(2, 2, 8, 0, 1, "", "\0\x0A\0\x14\0\x1E\x28"s)).codes,
              (Codes{10, 20, 30, 40}));
}

TEST(Png, DamagedFilesAreErrors) {
    const TemporaryFolder folder;
    save_png(folder / "a.png", random_image(3, 2));
    const std::string bytes = read_bytes_of(folder / "a.png");
    // Every chunk has a checksum, so all damage is refused, except perhaps in the ancillary sRGB
    // chunk (13 bytes), which does not change codes.
    EXPECT_GE(refusals_of_damaged(bytes, folder / "b.png", read_png),
              static_cast<int>(bytes.size()) - 13);
}

TEST(Png, PromisedSizesAreCheckedBeforeMemoryIsTaken) {
    const TemporaryFolder folder;
    const auto with_size = [&](std::uint32_t width, std::uint32_t height) {
        write_bytes_to(folder / "a.png", png_bytes(width, height, 8, 2, 0, "", "abc"));
        return error_of([&] { read_png(folder / "a.png"); });
    };
    EXPECT_NE(with_size(1000000, 1000000), "");
    EXPECT_NE(with_size(0, 5), "");
    EXPECT_NE(with_size(20000, 20000).find("20000 x 20000"), std::string::npos);
    EXPECT_NE(with_size(8000, 8000).find("192000000 bytes"), std::string::npos);
}

TEST(Png, RefusesFilesThatAreNotImages) {
    const TemporaryFolder folder;
    expect_error([&] { read_png(folder / "absent.png"); }, {"absent.png", "No such file"});
    expect_error([&] { read_png(folder.path()); }, {"not a regular file"});
    write_bytes_to(folder / "text.png", "this is not an image at all");
    expect_error([&] { read_png(folder / "text.png"); }, {"text.png", "PNG"});
}

TEST(Png, RefusesToWriteWhatIsNotFinite) {
    const TemporaryFolder folder;
    Image image(5, 4);
    image.pixel(0, 3)[3] = -std::numeric_limits<float>::infinity();
    expect_error([&] { save_png(folder / "a.png", image); },
                 {"a.png", "(0, 3)", "channel A", "-inf"});
    EXPECT_TRUE(folder.empty());
}

TEST(Png, FullDiskIsAnErrorAndLeavesNothing) {
    const TemporaryFolder folder;
    CodedImage image(300, 300, 3, 16);
    std::mt19937 random(1);
    for (std::uint16_t& code : image.codes) code = static_cast<std::uint16_t>(random());
    {
        const FileSizeLimit limit(20000);
        expect_error([&] { save_png(folder / "a.png", image); }, {"a.png", "cannot write"});
    }
    EXPECT_TRUE(folder.empty());
}

TEST(Png, ShowsAnnotationsOverThePictureAndBackground) {
    Image image(3, 1);
    image.pixel(1, 0)[0] = 0.25f;
    image.pixel(1, 0)[3] = 0.5f;
    const glm::dvec3 background(0, 0, 1);
    const auto plain = coded_picture("a", image, background, ImageColorSpace::display).codes.codes;
    auto layer = std::make_shared<Image>(3, 1);
    for (const int column : {1, 2}) {
        layer->pixel(column, 0)[1] = column == 1 ? 0.5f : 1;
        layer->pixel(column, 0)[3] = column == 1 ? 0.5f : 1;
    }
    image.annotations = layer;
    const auto shown = coded_picture("a", image, background, ImageColorSpace::display).codes.codes;
    for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(shown[c], plain[c]);
    // Half of (.25, 0, .5), and half of green: .125, .5, .25 of 255.
    EXPECT_EQ(std::vector<int>(shown.begin() + 3, shown.end()),
              (std::vector<int>{32, 128, 64, 0, 255, 0}));
}

}  // namespace
}  // namespace lamina
