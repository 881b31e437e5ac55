// SPDX-License-Identifier: Apache-2.0
// The codes of optical depth in float32 against compositing/codes.h, as its twin in
// shaders/compositing is tested.
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

constexpr std::size_t count = 1 << 16;
constexpr double ulp = 0x1p-24;
// Absolute, of logarithms of numbers up to 1024 (arithmetic_test.cpp): 1.8 roundings and one of the
// result, up to 6.9, itself.
constexpr double log_error = 9 * ulp;

template <class F>
void for_codes_and_shares(F f) {
    for (const NodeCode code : {NodeCode::minimax, NodeCode::phi, NodeCode::alpha})
        for (const float share : {1.0f, 1.0f / 3, 1.0f / 32, 1.0f / 1024}) f(code, share);
}

TEST_P(NodeCodes, Encode) {
    std::vector<float> depth(count), result(count);
    for (std::size_t i = 0; i < count; ++i)  // 1e-8 to 1e4
        depth[i] = static_cast<float>(std::exp2(static_cast<double>(i) * (40. / count) - 26.6));
    depth[0] = 0;
    depth[1] = static_cast<float>(opaque_node_depth);
    for_codes_and_shares([&](NodeCode code, float share) {
        vector_encode(code, share, depth, result);
        for (std::size_t i = 2; i < count; ++i) {
            const double expected = encode_depth(code, depth[i], share);
            // Opacity's 3e-7 with the roundings of the quotient before it and of two divisions by
            // 1 + ln(1 / share) / e; beyond sigma = 1 the logarithm over e.
            const double sigma = depth[i] / static_cast<double>(share);
            const bool logarithm = code == NodeCode::minimax && sigma > 1;
            const double absolute = logarithm ? log_error / std::numbers::e + 2 * ulp : 0;
            ASSERT_NEAR(result[i], expected, expected * (3e-7 + 4 * ulp) + absolute) << depth[i];
            ASSERT_LE(result[i], 1);
        }
        EXPECT_EQ(result[0], 0);
        EXPECT_NEAR(result[1], 1, 2 * ulp);
    });
}

TEST_P(NodeCodes, Decode) {
    std::vector<float> value(count), result(count), small(count), small_result(count);
    for (std::size_t i = 0; i < count; ++i) {
        value[i] = static_cast<float>(i) / (count - 1);
        small[i] = 1e-7f * value[i];
    }
    for_codes_and_shares([&](NodeCode code, float share) {
        vector_decode(code, share, value, result);
        vector_decode(code, share, small, small_result);
        for (std::size_t i = 0; i < count; ++i) {
            const double expected = decode_depth(code, value[i], share);
            // A depth of at least 1/4 knows its logarithm to 1.8 roundings and its own, below that
            // the series to 6; u = value (1 + ln(1 / share) / e) is known to two of numbers below
            // 4, which the logarithm passes on as it does the rounding of 1 - u.
            double relative = 2.5 / .28 * ulp;
            double absolute = 0;
            if (code == NodeCode::minimax) {
                // u's roundings, 3 of numbers up to 3.6 with the argument of exp(), e-fold, and
                // exp()'s 3; below u = 1 - 1/e the slope of log(1 - u) times u, at most e - 1.
                relative += (3 * 2 * 3.6 * std::numbers::e + 3) * ulp;
                // Beyond depth 1 the transmittance is a difference of such numbers.
                if (expected > 1) absolute = 4 * 3.6 * ulp * std::exp(expected);
            }
            ASSERT_NEAR(result[i], expected, expected * relative + absolute) << value[i];
            const double expected_small = decode_depth(code, small[i], share);
            ASSERT_NEAR(small_result[i], expected_small, expected_small * 8 * ulp) << small[i];
        }
        EXPECT_EQ(result[count - 1], static_cast<float>(opaque_node_depth));
        EXPECT_EQ(result[0], 0);
    });
}

}  // namespace
}  // namespace lamina
