// SPDX-License-Identifier: Apache-2.0
// The vector functions of codes, OVER, dithering and random bits equal those of src/compositing bit
// for bit. Scaled values and numbers are chosen as in tests/compositing/shader_twins_test.cpp.
#include <array>
#include <cmath>
#include <vector>

#include "compositing/codes.h"
#include "tiles/instruction_set_fixture.h"
#include "tiles/vector_functions.h"

namespace lamina {
namespace {

using Codes = EveryInstructionSet;
INSTANTIATE_TEST_SUITE_P(All, Codes, every_instruction_set, instruction_set_name);

constexpr std::uint32_t code_count = 1 << 16;

struct Operands {
    std::vector<double> color, alpha, below, above_alpha;
    CodeOperands view() const { return {color, alpha, below, above_alpha}; }
};

template <class F>
Operands operands_of(F operand) {
    Operands operands;
    for (std::vector<double>* values :
         {&operands.color, &operands.alpha, &operands.below, &operands.above_alpha}) {
        values->resize(code_count);
    }
    for (std::uint32_t i = 0; i < code_count; ++i) {
        operands.color[i] = operand(i, 0);
        operands.alpha[i] = operand(i, 1);
        operands.below[i] = operand(i, 2);
        operands.above_alpha[i] = operand(i, 3);
    }
    return operands;
}

std::uint32_t code(double value) {
    return static_cast<std::uint32_t>(value);
}

void expect_over_and_under(const Operands& operands, std::uint32_t largest) {
    std::vector<double> result(code_count);
    for (const OverRounding rounding : {OverRounding::separate, OverRounding::fused}) {
        vector_over(rounding, largest, operands.view(), result);
        for (std::uint32_t i = 0; i < code_count; ++i) {
            ASSERT_EQ(result[i], over(rounding, code(operands.color[i]), code(operands.alpha[i]),
                                      code(operands.below[i]), largest))
                << i;
        }
        vector_under(rounding, largest, operands.view(), result);
        for (std::uint32_t i = 0; i < code_count; ++i) {
            ASSERT_EQ(result[i],
                      under(rounding, code(operands.color[i]), code(operands.alpha[i]),
                            code(operands.below[i]), code(operands.above_alpha[i]), largest))
                << i;
        }
    }
}

TEST_P(Codes, OverOf4BitsMatchesScalarsForAllOperands) {
    expect_over_and_under(
        operands_of([](std::uint32_t i, std::uint32_t which) { return i >> 4 * which & 15; }), 15);
}

TEST_P(Codes, OverOf8BitsMatchesScalarsForAllPairs) {
    for (const std::uint32_t color : {0u, 1u, 2u, 63u, 100u, 127u, 128u, 200u, 254u, 255u}) {
        const auto operand = [color](std::uint32_t i, std::uint32_t which) {
            return which == 0 ? color : which == 1 ? i & 255 : i >> 8;
        };
        expect_over_and_under(operands_of(operand), 255);
    }
}

// Random operands; a quarter of them are 0 or the largest code, for which sums are largest.
TEST_P(Codes, OverMatchesScalarsForRandomOperands) {
    for (int bits = 1; bits <= max_code_bits; ++bits) {
        const std::uint32_t largest = largest_code(bits);
        const auto operand = [largest](std::uint32_t i, std::uint32_t which) {
            const std::uint32_t random = random_bits(i, which, 0, 77), choice = random >> 29;
            return choice == 0 ? 0 : choice == 1 ? largest : random & largest;
        };
        expect_over_and_under(operands_of(operand), largest);
    }
}

// Returns a scaled value, by index modulo 4: two are anywhere in 0..M, one is at or beside a whole
// number, by up to 2^-27 or 2^-33, and one at or beside a half.
double scaled_value(std::uint32_t index, std::uint32_t largest) {
    const std::uint32_t bits = random_bits(index, 0, 0, 3);
    if (index % 4 < 2) return static_cast<double>(largest) * bits * 0x1p-32;
    const double beside = (static_cast<double>(bits >> 24) - 128) * 0x1p-32;
    const double whole = bits % largest + (index % 4 == 2 ? .5 : 0);
    return std::fmax(whole + beside / ((index & 8) != 0 ? 4 : 256), 0);
}

// Returns a number in 0 .. size - 1: random, or the one at which a comparison with the value's
// fraction changes its result.
std::uint32_t chosen_number(std::uint32_t index, double scaled, double size) {
    if ((index & 16) != 0) return static_cast<std::uint32_t>((scaled - std::floor(scaled)) * size);
    return static_cast<std::uint32_t>(random_bits(index, 1, 0, 3) * 0x1p-32 * size);
}

TEST_P(Codes, RoundingOfAlphaMatchesScalars) {
    std::vector<double> scaled(code_count), result(code_count);
    std::vector<std::uint32_t> random(code_count);
    for (const int bits : {1, 2, 4, 6, 8, 10, 12, 16}) {
        for (std::uint32_t i = 0; i < code_count; ++i) {
            scaled[i] = scaled_value(i, largest_code(bits));
            random[i] = chosen_number(i, scaled[i], 0x1p32);
        }
        vector_code_nearest(scaled, result);
        for (std::uint32_t i = 0; i < code_count; ++i)
            ASSERT_EQ(result[i], code_nearest(scaled[i]));
        for (const AlphaRounding rounding :
             {AlphaRounding::truncate, AlphaRounding::nearest, AlphaRounding::stochastic}) {
            vector_round_alpha(rounding, scaled, random, result);
            for (std::uint32_t i = 0; i < code_count; ++i) {
                ASSERT_EQ(result[i], round_alpha(rounding, split_scaled(scaled[i]), random[i]))
                    << std::hexfloat << scaled[i];
            }
        }
    }
}

TEST_P(Codes, DitheringMatchesScalars) {
    struct Pattern {
        int period, increment;
    };
    std::vector<double> scaled(code_count), result(code_count);
    std::vector<std::uint32_t> rank(code_count);
    for (const int bits : {1, 2, 4, 6, 8, 10, 12, 16}) {
        const std::uint32_t largest = largest_code(bits);
        for (const auto& [period, increment] : {Pattern{11, 1}, {256, 1}, {64, 3}, {65536, 7}}) {
            for (std::uint32_t i = 0; i < code_count; ++i) {
                scaled[i] = i % 1024 == 0 ? largest : scaled_value(i, largest);
                rank[i] = chosen_number(i, scaled[i], period);
            }
            vector_dither(largest, period, increment, scaled, rank, result);
            for (std::uint32_t i = 0; i < code_count; ++i) {
                ASSERT_EQ(result[i], dither_code(scaled[i], rank[i], period, increment, largest))
                    << std::hexfloat << scaled[i] << " period " << period;
            }
        }
    }
}

TEST_P(Codes, StochasticOverMatchesScalars) {
    std::vector<double> source(code_count), alpha(code_count), below(code_count),
        result(code_count);
    std::vector<std::uint32_t> random(code_count);
    for (const int bits : {1, 4, 8, 16}) {
        const std::uint32_t largest = largest_code(bits);
        for (std::uint32_t i = 0; i < code_count; ++i) {
            alpha[i] = i % 64 == 0 ? 1 : random_bits(i, 2, 0, 3) * 0x1p-32;
            source[i] = alpha[i] * (i % 16 == 1 ? 1 : random_bits(i, 3, 0, 3) * 0x1p-32);
            below[i] = i % 16 == 1 ? largest : random_bits(i, 4, 0, 3) & largest;
            random[i] = chosen_number(i, largest * source[i] + below[i] * (1 - alpha[i]), 0x1p32);
        }
        vector_over_stochastic(largest, source, alpha, below, random, result);
        for (std::uint32_t i = 0; i < code_count; ++i) {
            ASSERT_EQ(result[i],
                      over_stochastic(source[i], alpha[i], code(below[i]), random[i], largest))
                << i;
        }
    }
}

TEST_P(Codes, RandomBitsMatchScalars) {
    std::vector<std::uint32_t> column(code_count), row(code_count), sample(code_count),
        result(code_count);
    for (std::uint32_t i = 0; i < code_count; ++i) {
        column[i] = i % 256;
        row[i] = i / 256;
        sample[i] = i % 3 == 0 ? i : 0x9e3779b9u * i;
    }
    for (const std::uint32_t seed : {0u, 1u, 77u, 0xffffffffu}) {
        vector_random_bits(column, row, sample, seed, result);
        for (std::uint32_t i = 0; i < code_count; ++i)
            ASSERT_EQ(result[i], random_bits(column[i], row[i], sample[i], seed));
    }
}

}  // namespace
}  // namespace lamina
