// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>
#include <vector>

#include "tiles/instruction_set_fixture.h"
#include "tiles/vector_functions.h"

namespace lamina {
namespace {

using Arithmetic = EveryInstructionSet;
INSTANTIATE_TEST_SUITE_P(All, Arithmetic, every_instruction_set, instruction_set_name);

constexpr std::size_t argument_count = 1 << 18;

// Returns numbers from first to last, equally spaced.
std::vector<float> spaced(double first, double last) {
    std::vector<float> numbers(argument_count);
    for (std::size_t i = 0; i < argument_count; ++i)
        numbers[i] =
            static_cast<float>(first + (last - first) * static_cast<double>(i) / argument_count);
    return numbers;
}

// Returns numbers from 2^first to 2^last, equally spaced in the exponent.
template <class T = float>
std::vector<T> octaves(double first, double last) {
    std::vector<T> numbers(argument_count);
    for (std::size_t i = 0; i < argument_count; ++i)
        numbers[i] = static_cast<T>(
            std::exp2(first + (last - first) * static_cast<double>(i) / argument_count));
    return numbers;
}

constexpr double ulp = 0x1p-24;  // the error of one rounding to float, relative

TEST_P(Arithmetic, ExponentialIsPreciseToFloat32) {
    const std::vector<float> x = spaced(-87, 88);
    std::vector<float> result(argument_count);
    vector_exp(x, result);
    for (std::size_t i = 0; i < argument_count; ++i) {
        const double expected = std::exp(static_cast<double>(x[i]));
        // With |f| < .35, e^f is 1 + f p(f). The last sum rounds once. The product, and the last
        // sum in p, count at most half a rounding each, because |f| < e^f / 2. Earlier roundings,
        // and that of f itself (127 * 2.1e-4 of one), add less than one. The polynomial is within
        // 1e-8 of the function.
        ASSERT_NEAR(result[i], expected, expected * (3 * ulp + 1e-8)) << x[i];
    }
}

TEST_P(Arithmetic, ExponentialIsSafeAtExtremes) {
    const std::vector<float> x = {
        0, -0.f, -88, -1e30f, -std::numeric_limits<float>::infinity(), 88.3, 1e30, 1, 1, 1, 1, 1,
        1, 1,    1,   1};
    std::vector<float> result(16);
    vector_exp(x, result);
    EXPECT_EQ(result[0], 1);
    EXPECT_EQ(result[1], 1);
    for (const std::size_t i : {2, 3, 4}) EXPECT_TRUE(result[i] > 0 && result[i] < 2e-38f);
    for (const std::size_t i : {5, 6}) EXPECT_NEAR(result[i] / std::exp(88.3), 1, 1e-5);
}

TEST_P(Arithmetic, LogarithmIsPreciseToFloat32) {
    const std::vector<float> x = octaves(-120, 127);
    std::vector<float> result(argument_count);
    vector_log(x, result);
    for (std::size_t i = 0; i < argument_count; ++i) {
        const double expected = std::log(static_cast<double>(x[i]));
        // log(m) is at most ln(2) / 2 = .347 and has 4.1 roundings: m + 1, the quotient, the
        // polynomial's last sum and the product with it; earlier ones count a hundredth. Of the two
        // sums with n log(2), one rounds a number of up to .36 and the other the result. The series
        // is cut at 2e-9.
        const double tolerance = (4.1 * .347 + .36) * ulp + std::abs(expected) * ulp;
        ASSERT_NEAR(result[i], expected, tolerance + 1e-9) << x[i];
    }
}

// Near 1, where n is 0, the result is log(m) alone, so the error is relative.
TEST_P(Arithmetic, LogarithmNearOneHasASmallRelativeError) {
    const std::vector<float> x = spaced(.75, 1.375);
    std::vector<float> result(argument_count);
    vector_log(x, result);
    for (std::size_t i = 0; i < argument_count; ++i) {
        const double expected = std::log(static_cast<double>(x[i]));
        ASSERT_NEAR(result[i], expected, std::abs(expected) * (4.1 * ulp + 2e-9)) << x[i];
    }
}

TEST_P(Arithmetic, OpacityFromDepthIsPreciseToFloat32) {
    const std::vector<float> depth = octaves(-60, 8);
    std::vector<float> result(argument_count);
    vector_opacity(depth, result);
    for (std::size_t i = 0; i < argument_count; ++i) {
        const double expected = -std::expm1(-static_cast<double>(depth[i]));
        ASSERT_NEAR(result[i], expected, expected * 3e-7) << depth[i];
        ASSERT_LE(result[i], 1);
    }
}

TEST_P(Arithmetic, OpacityFromDepthIsPreciseToDouble) {
    const std::vector<double> depth = octaves<double>(-80, 8);
    std::vector<double> result(argument_count);
    vector_opacity(depth, result);
    for (std::size_t i = 0; i < argument_count; ++i) {
        const double expected = -std::expm1(-depth[i]);
        ASSERT_NEAR(result[i], expected, expected * 1e-13) << depth[i];
    }
}

TEST_P(Arithmetic, OpacityIsExactAtItsEnds) {
    std::vector<float> depth(16, std::numeric_limits<float>::infinity());
    depth[0] = 0;
    std::vector<float> result(16);
    vector_opacity(depth, result);
    EXPECT_EQ(result[0], 0);
    EXPECT_EQ(result[1], 1);
}

}  // namespace
}  // namespace lamina
