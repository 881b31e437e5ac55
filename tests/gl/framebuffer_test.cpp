// SPDX-License-Identifier: Apache-2.0
#include "gl/framebuffer.h"

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "gl_fixture.h"

namespace lamina::gl {
namespace {

using FramebufferTest = EveryContextTest;
INSTANTIATE_TEST_SUITE_P(Contexts, FramebufferTest, both_contexts, context_name);

constexpr int width = 37;
constexpr int height = 5;

// Draws pixel (x, y), y from the bottom, as (x/65536, y/4, 1/3, 1.5) and reads it back.
Image draw_ramp(TextureFormat format) {
    const Framebuffer target(Texture::make_2d(format, width, height));
    target.bind();
    draw_full_screen(full_screen_program(R"(#version 450 core
        out vec4 color;
        void main() {
            vec2 pixel = floor(gl_FragCoord.xy);
            color = vec4(pixel.x / 65536.0, pixel.y / 4.0, 1.0 / 3.0, 1.5);
        }
    )"));
    return target.read_back();
}

// Expects draw_ramp() rounded to codes of `levels` steps and clamped to 1. Read-back may divide by
// multiplication with a rounded reciprocal, a relative error of 2^-23, so values are multiplied by
// `levels` before they are compared with codes.
void expect_codes(const Image& image, double levels) {
    for (int row = 0; row < height; ++row) {
        for (int x = 0; x < width; ++x) {
            const double y = height - 1 - row;
            const double drawn[4] = {x / 65536.0, y / 4.0, 1.0 / 3.0, 1.5};
            for (int c = 0; c < 4; ++c) {
                const double code = std::round(std::min(drawn[c], 1.0) * levels);
                EXPECT_NEAR(static_cast<double>(image.pixel(x, row)[c]) * levels, code,
                            levels * 1.2e-7)
                    << "pixel " << x << ", " << row << ", channel " << c;
            }
        }
    }
}

TEST_P(FramebufferTest, Fixed8HoldsRoundedCodes) {
    expect_codes(draw_ramp(TextureFormat::rgba8), 255);
}

// Its floats are more than are taken at once (128 MiB).
TEST_P(FramebufferTest, LargeTargetsAreReadInParts) {
    const int columns = 4096, rows = 2100;
    const Framebuffer target(Texture::make_2d(TextureFormat::r16, columns, rows));
    target.bind();
    draw_full_screen(full_screen_program(R"(#version 450 core
        out vec4 color;
        void main() { color = vec4(floor(gl_FragCoord.y) / 65535.0); }
    )"));
    const Image image = target.read_back();
    for (int row = 0; row < rows; ++row) {
        const long found = std::lround(image.pixel(columns - 1, row)[0] * 65535.0f);
        ASSERT_EQ(found, rows - 1 - row);
    }
}

TEST_P(FramebufferTest, Fixed16HoldsRoundedCodes) {
    expect_codes(draw_ramp(TextureFormat::rgba16), 65535);
}

TEST_P(FramebufferTest, Float32HoldsExactValues) {
    const Image image = draw_ramp(TextureFormat::rgba32f);
    for (int row = 0; row < height; ++row) {
        for (int x = 0; x < width; ++x) {
            const float* const pixel = image.pixel(x, row);
            EXPECT_EQ(pixel[0], static_cast<float>(x) / 65536.0f);
            EXPECT_EQ(pixel[1], static_cast<float>(height - 1 - row) / 4.0f);
            EXPECT_NEAR(pixel[2], 1.0 / 3.0, 3e-8);  // twice the rounding of float32 at 1/3, 1.5e-8
            EXPECT_EQ(pixel[3], 1.5f);
        }
    }
}

// x/65536 with x < 37 fits into 11 bits also where half floats are denormal (steps of 2^-24).
TEST_P(FramebufferTest, Float16HoldsElevenBits) {
    const Image image = draw_ramp(TextureFormat::rgba16f);
    for (int row = 0; row < height; ++row) {
        for (int x = 0; x < width; ++x) {
            const float* const pixel = image.pixel(x, row);
            EXPECT_EQ(pixel[0], static_cast<float>(x) / 65536.0f);
            EXPECT_EQ(pixel[1], static_cast<float>(height - 1 - row) / 4.0f);
            // 1/3 = 1365.33 * 2^-12. OpenGL lets drivers round down or to the nearest; both give
            // 1365.
            EXPECT_EQ(pixel[2], 1365.0f / 4096.0f);
            EXPECT_EQ(pixel[3], 1.5f);
        }
    }
}

TEST_P(FramebufferTest, DrawsIntoSeveralTexturesAtOnce) {
    std::vector<Texture> colors;
    colors.push_back(Texture::make_2d(TextureFormat::rgba32f, 2, 2));
    colors.push_back(Texture::make_2d(TextureFormat::r32f, 2, 2));
    Framebuffer target(std::move(colors));
    target.bind();
    draw_full_screen(full_screen_program(R"(#version 450 core
        layout(location = 0) out vec4 first;
        layout(location = 1) out float second;
        void main() { first = vec4(1, 2, 3, 4); second = 5; }
    )"));
    EXPECT_EQ(target.read_back(0).pixel(1, 1)[3], 4.0f);
    EXPECT_EQ(target.read_back(1).pixel(1, 0)[0], 5.0f);
    target.clear(glm::vec4(6.0f), 1);
    EXPECT_EQ(target.read_back(0).pixel(0, 0)[0], 1.0f);
    EXPECT_EQ(target.read_back(1).pixel(0, 0)[0], 6.0f);
}

// A target of one channel, for opacity: x/65536 with x < 37 fits into 11 bits. The other channels
// do not exist.
TEST_P(FramebufferTest, Float16OfOneChannelHoldsElevenBits) {
    const Image image = draw_ramp(TextureFormat::r16f);
    for (int x = 0; x < width; ++x) {
        EXPECT_EQ(image.pixel(x, 0)[0], static_cast<float>(x) / 65536.0f);
        EXPECT_EQ(image.pixel(x, 0)[1], 0.0f);
        EXPECT_EQ(image.pixel(x, 0)[3], 1.0f);
    }
}

}  // namespace
}  // namespace lamina::gl
