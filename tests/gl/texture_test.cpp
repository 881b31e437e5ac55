// SPDX-License-Identifier: Apache-2.0
#include "gl/texture.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "gl/framebuffer.h"
#include "gl_fixture.h"

namespace lamina::gl {
namespace {

using TextureTest = EveryContextTest;
INSTANTIATE_TEST_SUITE_P(Contexts, TextureTest, both_contexts, context_name);

// Fills the texture with zeros, uploads different values to the components of a box inside it, and
// compares every texel. `scale`: the value as which a component of 1 is read. Drivers may divide by
// 255 or 65535 with a rounded reciprocal, a relative error of 2^-23.
template <typename T>
void expect_sub_box(Texture texture, int channels, double scale) {
    const TexelBox box{2, texture.height() > 1 ? 1 : 0, texture.depth() > 1 ? 1 : 0,
                       3, texture.height() > 1 ? 2 : 1, texture.depth() > 1 ? 2 : 1};
    const std::vector<T> zeros(
        static_cast<std::size_t>(texture.width() * texture.height() * texture.depth() * channels));
    texture.upload({.width = texture.width(), .height = texture.height(), .depth = texture.depth()},
                   std::span<const T>(zeros));
    std::vector<T> components(
        static_cast<std::size_t>(box.width * box.height * box.depth * channels));
    std::iota(components.begin(), components.end(), T{1});
    texture.upload(box, std::span<const T>(components));

    const std::vector<float> read = texture.read_rgba();
    std::size_t texel = 0, component = 0;
    for (int z = 0; z < texture.depth(); ++z) {
        for (int y = 0; y < texture.height(); ++y) {
            for (int x = 0; x < texture.width(); ++x, ++texel) {
                const int u = x - box.x, v = y - box.y, w = z - box.z;
                const bool inside =
                    u >= 0 && u < box.width && v >= 0 && v < box.height && w >= 0 && w < box.depth;
                for (std::size_t c = 0; c < static_cast<std::size_t>(channels); ++c) {
                    const double expected =
                        inside ? static_cast<double>(components[component++]) * scale : 0.0;
                    EXPECT_NEAR(read[4 * texel + c], expected, 1.2e-7 * expected)
                        << "texel " << x << ", " << y << ", " << z << ", channel " << c;
                }
            }
        }
    }
}

TEST_P(TextureTest, UploadsBoxesOfVolumes) {
    expect_sub_box<std::uint8_t>(Texture::make_3d(TextureFormat::r8, 7, 5, 4), 1, 1 / 255.0);
    expect_sub_box<std::uint16_t>(Texture::make_3d(TextureFormat::r16, 7, 5, 4), 1, 1 / 65535.0);
    expect_sub_box<float>(Texture::make_3d(TextureFormat::r32f, 7, 5, 4), 1, 1);
}

TEST_P(TextureTest, UploadsBoxesOfTables) {
    expect_sub_box<float>(Texture::make_1d(TextureFormat::rgba32f, 9), 4, 1);
    expect_sub_box<float>(Texture::make_2d(TextureFormat::rg32f, 7, 5), 2, 1);
    expect_sub_box<float>(Texture::make_2d(TextureFormat::rgba32f, 7, 5), 4, 1);
    expect_sub_box<float>(Texture::make_3d(TextureFormat::rgba32f, 7, 5, 4), 4, 1);
    expect_sub_box<float>(Texture::make_3d(TextureFormat::r32f, 7, 5, 4), 1, 1);
}

TEST_P(TextureTest, UploadsBoxesOfImages) {
    expect_sub_box<std::uint8_t>(Texture::make_2d(TextureFormat::rgba8, 7, 5), 4, 1 / 255.0);
    expect_sub_box<std::uint16_t>(Texture::make_2d(TextureFormat::rgba16, 7, 5), 4, 1 / 65535.0);
    // The components are integers below 2^11, which half floats hold exactly.
    expect_sub_box<float>(Texture::make_2d(TextureFormat::rgba16f, 7, 5), 4, 1);
    expect_sub_box<float>(Texture::make_3d(TextureFormat::r16f, 7, 5, 4), 1, 1);
}

// The texture has more floats than read_rgba() reads at a time (2^24).
TEST_P(TextureTest, ReadsLargeTexturesInBands) {
    const int width = 4001, height = 1100;
    std::vector<std::uint8_t> codes(static_cast<std::size_t>(width) * height);
    for (std::size_t i = 0; i < codes.size(); ++i) codes[i] = static_cast<std::uint8_t>(i % 251);
    Texture texture = Texture::make_2d(TextureFormat::r8, width, height);
    texture.upload({.width = width, .height = height}, codes);
    const std::vector<float> read = texture.read_rgba();
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < codes.size(); ++i) {
        wrong += std::lround(read[4 * i] * 255.0f) != codes[i];
    }
    EXPECT_EQ(wrong, 0u);
}

// The texels 0, 1, 2, 3 are a ramp: halfway between two centres the value is their mean, beyond the
// outermost centres it is clamped.
TEST_P(TextureTest, FiltersAndClampsToTheEdge) {
    Texture ramp = Texture::make_1d(TextureFormat::r32f, 4);
    ramp.upload({.width = 4}, std::vector<float>{0, 1, 2, 3});
    ramp.set_filter(TextureFilter::linear);
    ramp.bind(3);
    const Framebuffer target(Texture::make_2d(TextureFormat::r32f, 13, 1));
    target.bind();
    Program program = full_screen_program(R"(#version 450 core
        uniform sampler1D ramp;
        out float value;
        void main() { value = texture(ramp, (floor(gl_FragCoord.x) * 0.5 - 1.0) / 4.0).r; }
    )");
    program.set("ramp", 3);
    draw_full_screen(program);
    const float expected[13] = {0, 0, 0, 0, .5f, 1, 1.5f, 2, 2.5f, 3, 3, 3, 3};
    const Image image = target.read_back();
    for (int x = 0; x < 13; ++x) EXPECT_EQ(image.pixel(x, 0)[0], expected[x]) << x;
}

TEST_P(TextureTest, CountsItsBytesAlsoWhenMoved) {
    Texture volume = Texture::make_3d(TextureFormat::r16, 10, 20, 30);
    EXPECT_EQ(bytes_allocated(), 12000);
    EXPECT_EQ(volume.byte_count(), 12000);
    Texture other = Texture::make_2d(TextureFormat::rgba16f, 10, 10);
    EXPECT_EQ(bytes_allocated(), 12800);
    volume = std::move(other);
    other = Texture();
    EXPECT_EQ(bytes_allocated(), 800);
    {
        const Framebuffer target(std::move(volume));
        EXPECT_EQ(bytes_allocated(), 800);
    }
    EXPECT_EQ(bytes_allocated(), 0);
}

template <typename Make>
void expect_refused(Make make, const std::string& part) {
    try {
        make();
        FAIL() << "no exception, expected: " << part;
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
    EXPECT_EQ(bytes_allocated(), 0);
}

TEST_P(TextureTest, RefusesSizesThatItCannotHave) {
    expect_refused([] { Texture::make_2d(TextureFormat::r8, 0, 4); }, "texture width 0");
    expect_refused([] { Texture::make_2d(TextureFormat::r8, 4, 1'000'000); },
                   "texture height 1000000");
    expect_refused([] { Texture::make_3d(TextureFormat::r8, 4, 4, 100'000); },
                   "texture depth 100000");
    // One slice more than 1 GiB: refused before the driver is asked.
    expect_refused([] { Texture::make_3d(TextureFormat::r32f, 1024, 1024, 257); },
                   "takes 1077936128 bytes, at most 1073741824 are allowed");
}

}  // namespace
}  // namespace lamina::gl
