// SPDX-License-Identifier: Apache-2.0
// The vector functions of node codes, in float32, against compositing/codes.h.
#include "compositing/codes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "tiles/instruction_set_fixture.h"
#include "tiles/vector_functions.h"

namespace lamina {
namespace {

using NodeCodes = EveryInstructionSet;
INSTANTIATE_TEST_SUITE_P(All, NodeCodes, every_instruction_set, instruction_set_name);

constexpr std::size_t depth_count = 1 << 16;
constexpr double float_ulp = 0x1p-24;
// Absolute error of log_of() for numbers up to 1024 (arithmetic_test.cpp): 1.8 ulp, and one
// rounding of the result, which is up to 6.9.
constexpr double log_error = 9 * float_ulp;

template <class F>
void for_codes_and_shares(F f) {
    for (const NodeCode code : {NodeCode::minimax, NodeCode::phi, NodeCode::alpha})
        for (const float share : {1.0f, 1.0f / 3, 1.0f / 32, 1.0f / 1024}) f(code, share);
}

TEST_P(NodeCodes, EncodeDepthsToFloat32) {
    std::vector<float> depth(depth_count), result(depth_count);
    for (std::size_t i = 0; i < depth_count; ++i)  // 1e-8 to 1e4
        depth[i] =
            static_cast<float>(std::exp2(static_cast<double>(i) * (40. / depth_count) - 26.6));
    depth[0] = 0;
    depth[1] = static_cast<float>(opaque_node_depth);
    for_codes_and_shares([&](NodeCode code, float share) {
        vector_encode(code, share, depth, result);
        for (std::size_t i = 2; i < depth_count; ++i) {
            const double expected = encode_depth(code, depth[i], share);
            // Relative error: 3e-7 of the opacity, and the roundings of the quotient before it and
            // of two divisions by 1 + ln(1 / share) / e. Beyond sigma = 1 the minimax code is a
            // logarithm over e, with an absolute error.
            const double sigma = depth[i] / static_cast<double>(share);
            const bool logarithm = code == NodeCode::minimax && sigma > 1;
            const double absolute = logarithm ? log_error / std::numbers::e + 2 * float_ulp : 0;
            ASSERT_NEAR(result[i], expected, expected * (3e-7 + 4 * float_ulp) + absolute)
                << depth[i];
            ASSERT_LE(result[i], 1);
        }
        EXPECT_EQ(result[0], 0);
        EXPECT_NEAR(result[1], 1, 2 * float_ulp);
    });
}

TEST_P(NodeCodes, DecodeDepthsToFloat32) {
    std::vector<float> value(depth_count), result(depth_count), small(depth_count),
        small_result(depth_count);
    for (std::size_t i = 0; i < depth_count; ++i) {
        value[i] = static_cast<float>(i) / (depth_count - 1);
        small[i] = 1e-7f * value[i];
    }
    for_codes_and_shares([&](NodeCode code, float share) {
        vector_decode(code, share, value, result);
        vector_decode(code, share, small, small_result);
        for (std::size_t i = 0; i < depth_count; ++i) {
            const double expected = decode_depth(code, value[i], share);
            // Relative error: for values of at least 1/4 the logarithm, of at least .28, has 1.8
            // roundings and its own; for smaller values the series has 6.
            double relative = 2.5 / .28 * float_ulp;
            double absolute = 0;
            if (code == NodeCode::minimax) {
                // u = value (1 + ln(1 / share) / e) and the argument of exp() have 3 roundings of
                // numbers up to 3.6, multiplied by e, and exp() has 3. Below u = 1 - 1/e the
                // logarithm passes on errors of u by its slope times u, at most e - 1, which is
                // less.
                relative += (3 * 2 * 3.6 * std::numbers::e + 3) * float_ulp;
                // Beyond depth 1 the transmittance is a difference of numbers up to 3.6.
                if (expected > 1) absolute = 4 * 3.6 * float_ulp * std::exp(expected);
            }
            ASSERT_NEAR(result[i], expected, expected * relative + absolute) << value[i];
            const double expected_small = decode_depth(code, small[i], share);
            ASSERT_NEAR(small_result[i], expected_small, expected_small * 8 * float_ulp)
                << small[i];
        }
        EXPECT_EQ(result[depth_count - 1], static_cast<float>(opaque_node_depth));
        EXPECT_EQ(result[0], 0);
    });
}

}  // namespace
}  // namespace lamina
