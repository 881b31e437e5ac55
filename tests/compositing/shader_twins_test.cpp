// SPDX-License-Identifier: Apache-2.0
// shaders/compositing computes the same numbers as src/compositing, bit for bit, except for the
// codes of optical depth, which it computes in float32.
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <string_view>

#include "compositing/codes.h"
#include "gl/framebuffer.h"
#include "gl/gl_fixture.h"

namespace lamina {
namespace {

using ShaderTwins = gl::GlTest;

// Size of the target. Pixels have indices, row by row from the bottom.
constexpr int edge = 256, pixels = edge * edge;

// A body of code as a fragment and as a compute shader. It sets `result` from `index`, the pixel's.
struct TwinProgram {
    gl::Program fragment, compute;

    template <typename Value>
    void set(std::string_view name, const Value& value) {
        fragment.set(name, value);
        compute.set(name, value);
    }
};

TwinProgram program_of(const std::string& include, const std::string& body,
                       const gl::Defines& defines) {
    const std::string head = "#version 450 core\n" + include +
                             "uniform int parameter;\n"
                             "uniform float share;\n";
    return {
        gl::full_screen_program(head +
                                    "out vec4 result;\n"
                                    "void main() {\n"
                                    "    uint column = uint(gl_FragCoord.x);\n"
                                    "    uint row = uint(gl_FragCoord.y);\n"
                                    "    uint index = column + 256u * row;\n" +
                                    body + "}\n",
                                defines),
        gl::compute_program(head +
                                "layout(local_size_x = 64) in;\n"
                                "layout(std430, binding = 0) buffer Results { vec4 results[]; };\n"
                                "void main() {\n"
                                "    vec4 result;\n"
                                "    uint index = gl_GlobalInvocationID.x;\n"
                                "    uint column = index & 255u;\n"
                                "    uint row = index >> 8;\n" +
                                body +
                                "    results[index] = result;\n"
                                "}\n",
                            defines)};
}

std::string include_of(const std::string& name) {
    return "#include \"compositing/" + name + ".glsl\"\n";
}

// A program's results, by the index of the pixel: the same numbers from both shaders.
class Results {
  public:
    explicit Results(TwinProgram& program) {
        gl::Framebuffer target(gl::Texture::make_2d(gl::TextureFormat::rgba32f, edge, edge));
        target.bind();
        gl::draw_full_screen(program.fragment);
        image_ = target.read_back();
        const gl::Buffer buffer(sizeof(float) * image_.rgba.size());
        buffer.bind_storage(0);
        program.compute.dispatch(pixels / 64);
        std::vector<float> computed(image_.rgba.size());
        buffer.read(std::span(computed));
        for (std::uint32_t index = 0; index < pixels; ++index) {
            const float* const pixel = computed.data() + 4 * std::size_t{index};
            if (!std::equal(pixel, pixel + 4, (*this)[index])) {
                ADD_FAILURE() << "the compute shader differs at " << index;
                return;
            }
        }
    }
    const float* operator[](std::uint32_t index) const {
        return image_.pixel(static_cast<int>(index % edge),
                            edge - 1 - static_cast<int>(index / edge));
    }

  private:
    Image image_;
};

// Codes are at most 65535, exact in float32.
void expect_codes(const Results& results, std::uint32_t index,
                  const std::array<std::uint32_t, 4>& expected) {
    for (std::size_t i = 0; i < 4; ++i) {
        ASSERT_EQ(results[index][i], static_cast<float>(expected[i]))
            << "channel " << i << " of index " << index;
    }
}

gl::Defines over_defines(int bits, OverRounding rounding) {
    gl::Defines defines;
    defines.set("BITS", bits);
    if (rounding == OverRounding::fused) defines.set("OVER_FUSED", 1);
    return defines;
}

TEST_F(ShaderTwins, AgreeOnOverOf4BitsForAllOperands) {
    for (const OverRounding rounding : {OverRounding::separate, OverRounding::fused}) {
        TwinProgram program = program_of(
            include_of("over"),
            "    uint color = index >> 12, alpha = index >> 8 & 15u, below = index >> 4 & 15u;\n"
            "    uint above_alpha = index & 15u;\n"
            "    result = vec4(over(color, alpha, below), over(15u, alpha, below),\n"
            "                  under(color, alpha, below, above_alpha),\n"
            "                  under(15u, alpha, below, below));\n",
            over_defines(4, rounding));
        const Results results(program);
        for (std::uint32_t i = 0; i < pixels; ++i) {
            const std::uint32_t color = i >> 12, alpha = i >> 8 & 15, below = i >> 4 & 15;
            expect_codes(
                results, i,
                {over(rounding, color, alpha, below, 15), over(rounding, 15, alpha, below, 15),
                 under(rounding, color, alpha, below, i & 15, 15),
                 under(rounding, 15, alpha, below, below, 15)});
        }
    }
}

TEST_F(ShaderTwins, AgreeOnOverOf8BitsForAllPairs) {
    for (const OverRounding rounding : {OverRounding::separate, OverRounding::fused}) {
        TwinProgram program = program_of(
            include_of("over"),
            "    uint color = uint(parameter);\n"
            "    result = vec4(over(color, column, row), over(255u, column, row),\n"
            "                  under(color, column, 0u, row), under(255u, column, row, row));\n",
            over_defines(8, rounding));
        for (const std::uint32_t color : {0u, 1u, 2u, 63u, 100u, 127u, 128u, 200u, 254u, 255u}) {
            program.set("parameter", static_cast<int>(color));
            const Results results(program);
            for (std::uint32_t i = 0; i < pixels; ++i) {
                const std::uint32_t alpha = i % 256, below = i / 256;
                expect_codes(results, i,
                             {over(rounding, color, alpha, below, 255),
                              over(rounding, 255, alpha, below, 255),
                              under(rounding, color, alpha, 0, below, 255),
                              under(rounding, 255, alpha, below, below, 255)});
            }
        }
    }
}

TEST_F(ShaderTwins, AgreeOnRandomBits) {
    TwinProgram program = program_of(
        include_of("random_bits"),
        "    uint first = random_bits(column, row, uint(parameter), 1u);\n"
        "    uint second = random_bits(first, index, column ^ row, ~uint(parameter));\n"
        "    result = vec4(first >> 16, first & 65535u, second >> 16, second & 65535u);\n",
        {});
    for (const std::uint32_t sample : {0u, 1u, 4095u, 1000000007u}) {
        program.set("parameter", static_cast<int>(sample));
        const Results results(program);
        for (std::uint32_t i = 0; i < pixels; ++i) {
            const std::uint32_t first = random_bits(i % 256, i / 256, sample, 1);
            const std::uint32_t second = random_bits(first, i, i % 256 ^ i / 256, ~sample);
            expect_codes(results, i, {first >> 16, first & 65535, second >> 16, second & 65535});
        }
    }
}

class ShaderTwinsOfBits : public gl::ContextTest<testing::TestWithParam<int>> {
  protected:
    void SetUp() override { make_context(gl::ContextKind::osmesa); }
};

// Operands are random; every fourth is 0 or the largest code, with which sums are extreme.
TEST_P(ShaderTwinsOfBits, AgreeOnOverOfRandomOperands) {
    const std::uint32_t largest = largest_code(GetParam());
    const auto operand = [&](std::uint32_t i, std::uint32_t which) {
        const std::uint32_t bits = random_bits(i, which, 0, 77);
        const std::uint32_t choice = bits >> 29;
        return choice == 0 ? 0 : choice == 1 ? largest : bits & largest;
    };
    for (const OverRounding rounding : {OverRounding::separate, OverRounding::fused}) {
        TwinProgram program = program_of(
            include_of("over") + include_of("random_bits") +
                "uint operand(uint index, uint which) {\n"
                "    uint bits = random_bits(index, which, 0u, 77u), choice = bits >> 29;\n"
                "    return choice == 0u ? 0u : choice == 1u ? LARGEST_CODE : bits & "
                "LARGEST_CODE;\n"
                "}\n",
            "    uint color = operand(index, 0u), alpha = operand(index, 1u);\n"
            "    uint below = operand(index, 2u), above_alpha = operand(index, 3u);\n"
            "    result = vec4(over(color, alpha, below), over(LARGEST_CODE, alpha, below),\n"
            "                  under(color, alpha, 0u, above_alpha),\n"
            "                  under(LARGEST_CODE, alpha, below, below));\n",
            over_defines(GetParam(), rounding));
        const Results results(program);
        for (std::uint32_t i = 0; i < pixels; ++i) {
            const std::uint32_t color = operand(i, 0), alpha = operand(i, 1), below = operand(i, 2);
            expect_codes(results, i,
                         {over(rounding, color, alpha, below, largest),
                          over(rounding, largest, alpha, below, largest),
                          under(rounding, color, alpha, 0, operand(i, 3), largest),
                          under(rounding, largest, alpha, below, below, largest)});
        }
    }
}

// GLSL for scaled values, from operations that round alike in C++ and in GLSL. Of four, two are
// anywhere in 0..M, one is at or beside a whole number by up to 2^-27 or 2^-33 (code_noise is 1e-9,
// 2^-29.9), and one at or beside a half.
constexpr const char* scaled_value =
    "const double exp2_minus_32 = 1.0LF / 4294967296.0LF;\n"
    "double scaled_value(uint index) {\n"
    "    uint bits = random_bits(index, 0u, 0u, 3u);\n"
    "    if (index % 4u < 2u) return double(LARGEST_CODE) * double(bits) * exp2_minus_32;\n"
    "    double beside = (double(bits >> 24) - 128.0LF) * exp2_minus_32;\n"
    "    beside /= (index & 8u) != 0u ? 4.0LF : 256.0LF;\n"
    "    double code = double(bits % LARGEST_CODE) + (index % 4u == 2u ? 0.5LF : 0.0LF);\n"
    "    return max(code + beside, 0.0LF);\n"
    "}\n";

double scaled_value_of(std::uint32_t index, std::uint32_t largest) {
    const std::uint32_t bits = random_bits(index, 0, 0, 3);
    if (index % 4 < 2) return static_cast<double>(largest) * bits * 0x1p-32;
    const double beside = (static_cast<double>(bits >> 24) - 128) * 0x1p-32;
    const double code = bits % largest + (index % 4 == 2 ? .5 : 0);
    return std::fmax(code + beside / ((index & 8) != 0 ? 4 : 256), 0);
}

// GLSL for numbers from 0 to `size`, alternating every 16 indices between random ones and the one
// at which a comparison with the value's rest changes.
constexpr const char* chosen_number =
    "uint chosen_number(uint index, double scaled, double size) {\n"
    "    if ((index & 16u) != 0u) return uint((scaled - floor(scaled)) * size);\n"
    "    return uint(double(random_bits(index, 1u, 0u, 3u)) * exp2_minus_32 * size);\n"
    "}\n";

std::uint32_t chosen_number_of(std::uint32_t index, double scaled, double size) {
    if ((index & 16) != 0) return static_cast<std::uint32_t>((scaled - std::floor(scaled)) * size);
    return static_cast<std::uint32_t>(random_bits(index, 1, 0, 3) * 0x1p-32 * size);
}

TEST_P(ShaderTwinsOfBits, AgreeOnRoundingAndDithering) {
    const int bits = GetParam();
    const std::uint32_t largest = largest_code(bits);
    struct Case {
        AlphaRounding rounding;
        int period, increment;
    };
    for (const auto& [rounding, period, increment] :
         {Case{AlphaRounding::truncate, 11, 1}, Case{AlphaRounding::nearest, 256, 1},
          Case{AlphaRounding::stochastic, 64, 3}, Case{AlphaRounding::truncate, 65536, 7}}) {
        gl::Defines defines;
        defines.set("BITS", bits);
        defines.set("ALPHA_ROUNDING", static_cast<int>(rounding));
        defines.set("DITHER_PERIOD", period);
        defines.set("DITHER_INCREMENT", increment);
        TwinProgram program = program_of(
            include_of("dither") + include_of("random_bits") + scaled_value + chosen_number,
            "    double scaled = scaled_value(index);\n"
            "    uint random = chosen_number(index, scaled, 4294967296.0LF);\n"
            "    uint rank = chosen_number(index, scaled, double(DITHER_PERIOD));\n"
            "    result = vec4(code_nearest(scaled), round_alpha(split_scaled(scaled), random),\n"
            "                  dither_code(scaled, rank),\n"
            "                  dither_code(double(LARGEST_CODE), DITHER_PERIOD - 1u));\n",
            defines);
        const Results results(program);
        for (std::uint32_t i = 0; i < pixels; ++i) {
            const double scaled = scaled_value_of(i, largest);
            const std::uint32_t random = chosen_number_of(i, scaled, 0x1p32);
            const std::uint32_t rank = chosen_number_of(i, scaled, period);
            expect_codes(results, i,
                         {code_nearest(scaled), round_alpha(rounding, split_scaled(scaled), random),
                          dither_code(scaled, rank, period, increment, largest), largest});
            if (HasFatalFailure()) FAIL() << std::hexfloat << scaled << " period " << period;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(All, ShaderTwinsOfBits, testing::Values(1, 2, 4, 6, 8, 10, 12, 16));

TwinProgram depth_program(NodeCode code, const std::string& body) {
    constexpr std::array names = {"CODE_MINIMAX", "CODE_PHI", "CODE_ALPHA"};
    gl::Defines defines;
    defines.set("NODE_CODE", names[static_cast<std::size_t>(code)]);
    return program_of(include_of("node_code"), body, defines);
}

// Error that GLSL allows for logarithms here: 2^-21 absolute between 1/2 and 2, elsewhere 3 units
// in the last place, which for ln 1024 are 3 * 2^-21. It allows 3 + 2 |x| units for exp(x) (GLSL
// 4.50, section 4.7.1).
constexpr double log_error = 3 * 0x1p-21;

TEST_F(ShaderTwins, AgreeOnDepthFromOpacity) {
    TwinProgram program = depth_program(
        NodeCode::phi,
        "    float value = index < 32768u ? exp2(float(index) * (26.0 / 32768.0) - 27.0)\n"
        "                                 : float(index - 32768u) / 32768.0;\n"
        "    result = vec4(value, depth_from_opacity(value), 0.0, 1.0);\n");
    const Results results(program);
    for (std::uint32_t i = 0; i < pixels; ++i) {
        const double value = results[i][0], expected = -std::log1p(-value);
        // Below 1/4 there are some ten roundings of 2^-24, of which the largest are of the result
        // itself, and 2e-8 of truncation. Above 1/4 there are the logarithm's error and the
        // rounding of 1 - value.
        const double tolerance = value < .25 ? expected * 4e-7 : 0x1p-21 + expected * 4e-7;
        ASSERT_NEAR(results[i][1], expected, tolerance) << value;
    }
}

class DepthTwins : public gl::ContextTest<testing::TestWithParam<std::tuple<NodeCode, float>>> {
  protected:
    void SetUp() override { make_context(gl::ContextKind::osmesa); }
};

TEST_P(DepthTwins, AgreeOnEncodedDepths) {
    const auto [code, share] = GetParam();
    TwinProgram program = depth_program(
        code,
        "    float depth = exp2(float(index) * (40.0 / 65536.0) - 26.6);\n"
        "    result = vec4(depth, encode_depth(depth, share), encode_depth(0.0, share),\n"
        "                  encode_depth(opaque_node_depth, share));\n");
    program.set("share", share);
    const Results results(program);
    for (std::uint32_t i = 0; i < pixels; ++i) {  // depths from 1e-8 to 1e4
        const double expected = encode_depth(code, results[i][0], share);
        // The relative error is the series' 4e-7 (tests/slicing/twins_test.cpp), and as much for
        // the division by 1 + ln(1 / share) / e. The absolute error, if depth or sigma is above
        // 1/4, is that of two logarithms over e, and of the exponential, 3 units and at most .74
        // more for 2 x exp(-x).
        const double steep = results[i][0] / (code == NodeCode::alpha ? 1 : share);
        const double absolute = steep < .25 ? 0 : 2 * log_error / std::exp(1.) + 4 * 0x1p-24;
        ASSERT_NEAR(results[i][1], expected, expected * 8e-7 + absolute) << results[i][0];
        ASSERT_LE(results[i][1], 1);
        ASSERT_EQ(results[i][2], 0);
        ASSERT_NEAR(results[i][3], 1, 0x1p-23);
    }
}

TEST_P(DepthTwins, AgreeOnDecodedDepths) {
    const auto [code, share] = GetParam();
    TwinProgram program = depth_program(code,
                                        "    float value = float(index) / 65535.0;\n"
                                        "    result = vec4(value, decode_depth(value, share),\n"
                                        "                  decode_depth(1e-7 * value, share), "
                                        "1e-7 * value);\n");
    program.set("share", share);
    const Results results(program);
    for (std::uint32_t i = 0; i < pixels; ++i) {
        const double value = results[i][0], expected = decode_depth(code, value, share);
        // The relative error is the logarithm's 2^-21 of a depth of at least .28
        // (AgreeOnDepthFromOpacity) and 8e-7 of other roundings. Minimax takes exp() of up to ln
        // 1024, 6.9, from numbers u <= 3.6 with an error of log_error / e: the exponential has e
        // times this error, three roundings of such numbers (2^-22) and 17 units of exp() itself.
        double relative = 0x1p-21 / .28 + 8e-7;
        if (code == NodeCode::minimax) relative += log_error + 3 * 0x1p-22 + 17 * 0x1p-24;
        // Beyond depth 1, minimax's transmittance is a difference of numbers with such errors.
        const double absolute =
            code == NodeCode::minimax && expected > 1 ? 2 * log_error * std::exp(expected) : 0;
        ASSERT_NEAR(results[i][1], expected, expected * relative + absolute) << value;
        ASSERT_NEAR(results[i][2], decode_depth(code, results[i][3], share),
                    decode_depth(code, results[i][3], share) * 1.2e-6);
    }
    EXPECT_EQ(results[pixels - 1][1], static_cast<float>(opaque_node_depth));
    EXPECT_EQ(results[0][1], 0);
}

INSTANTIATE_TEST_SUITE_P(All, DepthTwins,
                         testing::Combine(testing::Values(NodeCode::minimax, NodeCode::phi,
                                                          NodeCode::alpha),
                                          testing::Values(1.0f, 1.0f / 32, 1.0f / 1024)));

}  // namespace
}  // namespace lamina
