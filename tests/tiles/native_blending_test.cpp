// SPDX-License-Identifier: Apache-2.0
// blend() gives the same pixels, after every fragment, as the blending unit of software OpenGL.
#include <glad/gl.h>

#include <array>
#include <cmath>
#include <vector>

#include "compositing/codes.h"
#include "gl/api.h"
#include "gl/framebuffer.h"
#include "gl/gl_fixture.h"
#include "tiles/instruction_set_fixture.h"
#include "tiles/vector_functions.h"

namespace lamina {
namespace {

using NativeBlending = gl::GlTest;

constexpr int edge = 256, layers = 24;
constexpr std::size_t pixels = edge * edge;

using Planes = std::array<std::vector<float>, 4>;

// Returns a random number in 0 .. 1.
float unit(std::size_t i, int layer, std::uint32_t channel) {
    const std::uint32_t random =
        random_bits(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(layer), channel, 9);
    return static_cast<float>(random >> 8) * 0x1p-24f;
}

// Returns associated colours and opacities. Of four pixels one has opacities around 1/1000, one has
// colours at or beside the middle between two 8-bit codes, and two are random. Some are opaque,
// some empty, and some colours exceed 1.
Planes fragments_of(int layer) {
    Planes planes;
    for (std::uint32_t channel = 0; channel < 4; ++channel) planes[channel].resize(pixels);
    for (std::size_t i = 0; i < pixels; ++i) {
        float alpha = unit(i, layer, 3) * (i % 4 == 0 ? .002f : 1);
        if (i % 31 == static_cast<std::size_t>(layer)) alpha = 1;
        if (i % 37 == static_cast<std::size_t>(layer)) alpha = 0;
        planes[3][i] = alpha;
        for (std::uint32_t channel = 0; channel < 3; ++channel) {
            const float value = unit(i, layer, channel) * (i % 19 == 0 ? 2 : 1);
            const float middle = (std::floor(value * 255) + .5f) / 255;
            planes[channel][i] =
                i % 4 != 1 ? value * alpha : middle * (1 + (value - .5f) * 0x1p-20f);
        }
    }
    return planes;
}

TargetBlend native(Target target, Order order) {
    TargetBlend blend;
    blend.target = target;
    blend.order = order;
    blend.bits = target == Target::fixed16 ? 16 : 8;
    if (is_fixed_point(target)) blend.largest = static_cast<float>(largest_code(blend.bits));
    return blend;
}

gl::TextureFormat format_of(Target target) {
    switch (target) {
        case Target::float32:
            return gl::TextureFormat::rgba32f;
        case Target::float16:
            return gl::TextureFormat::rgba16f;
        case Target::fixed16:
            return gl::TextureFormat::rgba16;
        default:
            return gl::TextureFormat::rgba8;
    }
}

// Draws the same fragments with OpenGL and with blend(), and calls compare(drawn, computed, layer)
// after every layer.
template <class F>
void composite_both_ways(const TargetBlend& target, F compare) {
    gl::Program program = gl::full_screen_program(
        "#version 450 core\n"
        "uniform sampler2D fragments;\n"
        "out vec4 associated;\n"
        "void main() { associated = texelFetch(fragments, ivec2(gl_FragCoord.xy), 0); }\n");
    program.set("fragments", 0);
    gl::Texture texture = gl::Texture::make_2d(gl::TextureFormat::rgba32f, edge, edge);
    gl::Framebuffer drawn(gl::Texture::make_2d(format_of(target.target), edge, edge));
    drawn.clear(glm::vec4(0));
    Planes computed;
    for (std::vector<float>& plane : computed) plane.resize(pixels);
    for (int layer = 0; layer < layers; ++layer) {
        const Planes fragments = fragments_of(layer);
        std::vector<float> interleaved(4 * pixels);
        for (std::size_t i = 0; i < 4 * pixels; ++i) interleaved[i] = fragments[i % 4][i / 4];
        texture.upload({0, 0, 0, edge, edge, 1}, interleaved);
        texture.bind(0);
        drawn.bind();
        gl::api().Enable(GL_BLEND);
        if (target.order == Order::back_to_front) {
            gl::api().BlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
        } else {
            gl::api().BlendFunc(GL_ONE_MINUS_DST_ALPHA, GL_ONE);
        }
        gl::draw_full_screen(program);
        gl::api().Disable(GL_BLEND);
        vector_blend(target, {{fragments[0], fragments[1], fragments[2], fragments[3]}},
                     {{computed[0], computed[1], computed[2], computed[3]}});
        compare(drawn.color().read_rgba(), computed, layer);
    }
}

void expect_equal(Target format, Order order) {
    const TargetBlend target = native(format, order);
    std::size_t different = 0;
    double largest = 0;
    composite_both_ways(
        target, [&](const std::vector<float>& drawn, const Planes& computed, int layer) {
            for (std::size_t i = 0; i < 4 * pixels; ++i) {
                const float ours = computed[i % 4][i / 4];
                float theirs = drawn[i];  // if fixed-point: code / M, rounded
                if (is_fixed_point(format)) theirs = std::round(theirs * target.largest);
                if (ours == theirs) continue;
                if (different++ < 5) {
                    ADD_FAILURE() << std::hexfloat << "layer " << layer << " pixel " << i / 4
                                  << " channel " << i % 4 << ": " << drawn[i] * target.largest
                                  << " is " << ours * target.largest;
                }
                largest = std::max(largest, std::abs(static_cast<double>(ours) - theirs));
            }
        });
    EXPECT_EQ(different, 0u) << "of " << 4 * pixels * layers << ", by up to " << largest;
}

TEST_F(NativeBlending, MatchesOpenGlInFixed8) {
    expect_equal(Target::fixed8, Order::back_to_front);
    expect_equal(Target::fixed8, Order::front_to_back);
}

TEST_F(NativeBlending, MatchesOpenGlInFixed16) {
    expect_equal(Target::fixed16, Order::back_to_front);
    expect_equal(Target::fixed16, Order::front_to_back);
}

TEST_F(NativeBlending, MatchesOpenGlInFloat16) {
    expect_equal(Target::float16, Order::back_to_front);
    expect_equal(Target::float16, Order::front_to_back);
}

TEST_F(NativeBlending, MatchesOpenGlInFloat32) {
    expect_equal(Target::float32, Order::back_to_front);
    expect_equal(Target::float32, Order::front_to_back);
}

}  // namespace
}  // namespace lamina
