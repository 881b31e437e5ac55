// SPDX-License-Identifier: Apache-2.0
// Rounding of opacities to codes of n bits, and its random numbers.
#include "compositing/codes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "compositing/fixed_ray.h"

namespace lamina {
namespace {

std::uint32_t rounded(AlphaRounding rounding, double scaled, std::uint32_t random = 0) {
    return round_alpha(rounding, split_scaled(scaled), random);
}

TEST(Codes, RoundAsTheirNamesSay) {
    for (const double rest : {.01, .25, .49, .51, .75, .99}) {
        for (const std::uint32_t whole : {0u, 1u, 100u, 254u, 65534u}) {
            const double scaled = whole + rest;
            EXPECT_EQ(rounded(AlphaRounding::truncate, scaled), whole);
            EXPECT_EQ(rounded(AlphaRounding::nearest, scaled), whole + (rest > .5 ? 1 : 0));
            EXPECT_EQ(rounded(AlphaRounding::stochastic, scaled, 0), whole + 1);
            EXPECT_EQ(rounded(AlphaRounding::stochastic, scaled, 0xffffffffu), whole);
            EXPECT_EQ(code_nearest(scaled), whole + (rest > .5 ? 1 : 0));
        }
    }
    // A half goes up: the paper's colour 0.5 is code 128 (docs/numerics.md, section 2).
    EXPECT_EQ(code_nearest(255 * .5), 128u);
    EXPECT_EQ(rounded(AlphaRounding::nearest, 255 * .5), 128u);
}

// Opacities that are codes already, as in a palette, are the same codes after double arithmetic.
TEST(Codes, OpacitiesThatAreCodesKeepTheirCode) {
    for (int bits = 1; bits <= max_code_bits; ++bits) {
        const std::uint32_t largest = largest_code(bits);
        for (std::uint32_t k = 0; k <= largest; ++k) {
            const double scaled = opacity_over(static_cast<double>(k) / largest, 1) * largest;
            // The random number is 2^-16 of its range, so an error of more than 2^-16 codes would
            // show in stochastic rounding.
            for (const double noisy : {scaled, scaled * (1 - 0x1p-52), scaled * (1 + 0x1p-52)}) {
                if (noisy > largest) continue;
                ASSERT_EQ(rounded(AlphaRounding::truncate, noisy), k);
                ASSERT_EQ(rounded(AlphaRounding::nearest, noisy), k);
                ASSERT_EQ(rounded(AlphaRounding::stochastic, noisy, 1u << 16), k);
            }
        }
    }
}

// The opacities of equal pieces of a ray, composited, give that of the ray.
TEST(Codes, OpacityOverSharesMultipliesTransmittance) {
    for (const double unit : {1e-12, 1e-6, .1, .5, .999, 1 - 1e-12}) {
        for (const double share : {.5, .25, 1e-3}) {
            const double part = opacity_over(unit, share);
            // log1p, a product and expm1 have errors of one unit in the last place each. The first
            // two, relative to the logarithm of the transmittance, at most 28, become errors of the
            // transmittance.
            EXPECT_NEAR(opacity_over(part, 1 / share), unit, unit * 4e-15 + 28 * 4e-16 * (1 - unit))
                << unit << " " << share;
        }
    }
    EXPECT_EQ(opacity_over(0, .3), 0);
    EXPECT_EQ(opacity_over(1, .3), 1);
    EXPECT_EQ(opacity_over(.3, 1), .3);
}

// The values are of the hash of Jarzynski and Olano, computed from the paper's text by another
// program.
TEST(Codes, RandomBitsAreThoseOfPcg4d) {
    EXPECT_EQ(random_bits(0, 0, 0, 0), 0xd32548eau);
    EXPECT_EQ(random_bits(1, 2, 3, 4), 0x2b94c2fu);
    EXPECT_EQ(random_bits(1023, 767, 4095, 0xffffffffu), 0x3cbaaf44u);
}

TEST(Codes, StochasticRoundingHasNoBias) {
    constexpr int columns = 64, rows = 64, samples = 16, count = columns * rows * samples;
    for (const double rest : {.003, .1, .5, .77, .998}) {
        double sum = 0;
        for (std::uint32_t column = 0; column < columns; ++column) {
            for (std::uint32_t row = 0; row < rows; ++row) {
                for (std::uint32_t sample = 0; sample < samples; ++sample) {
                    sum += rounded(AlphaRounding::stochastic, 7 + rest,
                                   random_bits(column, row, sample, 1));
                }
            }
        }
        // The tolerance is five standard deviations of the mean of `count` choices between 7 and 8.
        EXPECT_NEAR(sum / count, 7 + rest, 5 * std::sqrt(rest * (1 - rest) / count)) << rest;
    }
}

TEST(Codes, StochasticRoundingIsReproducibleAndDiffersByPlaceAndSeed) {
    const std::vector<RaySample> ray(50, {.5, .31 / 255});
    const auto pixels = [&](std::uint32_t seed) {
        std::vector<std::uint32_t> alphas;
        for (std::uint32_t column = 0; column < 40; ++column) {
            Emulation emulation;
            emulation.alpha = AlphaRounding::stochastic;
            emulation.seed = seed;
            alphas.push_back(
                composite_straight(ray, emulation, {}, Order::back_to_front, column, 3).alpha);
        }
        return alphas;
    };
    EXPECT_EQ(pixels(1), pixels(1));
    EXPECT_NE(pixels(1), pixels(2));
    const std::vector<std::uint32_t> alphas = pixels(1);
    // Each pixel has 50 choices with probability .31: 40 equal counts would not be random.
    EXPECT_GT(std::set(alphas.begin(), alphas.end()).size(), 4u);
}

}  // namespace
}  // namespace lamina
